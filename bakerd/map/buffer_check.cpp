#include "bakerd/map/buffer_check.h"

#include "bakerd/map/file_source.h"
#include "map_files/reference.h"

#include <utility>

namespace drtv::map {
namespace {

// The document that names files, and those that it names.
struct Outside {
    const std::string& document;
    std::vector<OutsideBytes>& bytes;
};

// A uri becomes what tinygltf shall read: plain base64, or a place in `outside`.
CheckResult check_uri(Json& element, const std::string& where, SizeBytes size_bytes, Outside& outside) {
    const std::string uri = element["uri"].get<std::string>();
    if (map_files::is_data_uri(uri)) {
        auto plain = plain_data_uri(uri, size_bytes);
        if (!plain)
            return wrong("{}: {}", where, plain.error());
        element["uri"] = std::move(*plain);
        return {};
    }
    auto files = map_files::files_named(outside.document, uri);
    if (!files)
        return wrong("{}: {}", where, files.error());
    element["uri"] = std::to_string(outside.bytes.size());
    element["name"] = files->front();
    outside.bytes.push_back({where, std::move(*files), size_bytes});
    return {};
}

CheckResult check_buffer(const Checker& check, Json& buffer, const std::string& where, Outside& outside) {
    if (CheckResult checked =
            check.properties(buffer, where, {required(size_at("byteLength")), string_at("uri")});
        !checked)
        return checked;
    const auto size_bytes = buffer["byteLength"].get<std::size_t>();
    if (size_bytes == 0 || size_bytes > max_file_bytes)
        return wrong("{}: byteLength {} does not lie between 1 and {}", where, size_bytes, max_file_bytes);
    if (buffer.contains("uri"))
        return check_uri(buffer, where, size_bytes, outside);
    // Only the first buffer may be the GLB's binary chunk.
    if (where != "buffer 0")
        return wrong("{} has no uri", where);
    buffer["uri"] = std::to_string(outside.bytes.size());
    outside.bytes.push_back({where, {}, size_bytes});
    return {};
}

CheckResult check_buffer_view(const Checker& check, Json& view, const std::string& where) {
    const std::initializer_list<Property> members = {required(reference_at("buffer", "buffers")),
                                                     size_at("byteOffset"),
                                                     required(size_at("byteLength")),
                                                     size_at("byteStride")};
    if (CheckResult checked = check.properties(view, where, members); !checked)
        return checked;
    const auto size_bytes = view["byteLength"].get<std::size_t>();
    const auto end = view.value("byteOffset", std::size_t{0}) + size_bytes;
    const Json& buffer = check.element("buffers", view["buffer"]);
    const auto buffer_bytes = buffer["byteLength"].get<std::size_t>();
    if (end > buffer_bytes)
        return wrong(
            "{} ends at {}, buffer {} has {} bytes", where, end, shown(view["buffer"]), buffer_bytes);
    const auto stride = view.value("byteStride", std::size_t{4});
    if (stride % 4 != 0 || stride > 252)
        return wrong("{}: byteStride {} is not a multiple of 4 up to 252", where, stride);
    return {};
}

CheckResult check_image(const Checker& check, Json& image, const std::string& where, Outside& outside) {
    const std::initializer_list<Property> members = {
        string_at("uri"), reference_at("bufferView", "bufferViews"), string_at("mimeType")};
    if (CheckResult checked = check.properties(image, where, members); !checked)
        return checked;
    if (image.contains("uri") == image.contains("bufferView"))
        return wrong("{} must have either a uri or a bufferView", where);
    if (image.contains("uri"))
        return check_uri(image, where, std::nullopt, outside);
    const Json& view = check.element("bufferViews", image["bufferView"]);
    if (view["byteLength"] == 0)
        return wrong("{}: bufferView {} is empty", where, shown(image["bufferView"]));
    return {};
}

}  // namespace

CheckResult check_buffers(const Checker& check,
                          const std::string& document,
                          std::vector<OutsideBytes>& outside_bytes) {
    Outside outside{document, outside_bytes};
    const auto check_one_buffer = [&](Json& buffer, const std::string& where) {
        return check_buffer(check, buffer, where, outside);
    };
    if (CheckResult checked = check.each("buffers", "buffer", check_one_buffer); !checked)
        return checked;
    const auto check_view = [&](Json& view, const std::string& where) {
        return check_buffer_view(check, view, where);
    };
    if (CheckResult checked = check.each("bufferViews", "bufferView", check_view); !checked)
        return checked;
    return check.each("images", "image", [&](Json& image, const std::string& where) {
        return check_image(check, image, where, outside);
    });
}

}  // namespace drtv::map
