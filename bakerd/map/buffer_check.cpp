#include "bakerd/map/buffer_check.h"

#include "bakerd/map/file_source.h"

#include <utility>

namespace drtv::map {
namespace {

// What %xx decodes to may be anything; JSON and the service hold UTF-8 only.
bool is_utf8(const std::string& text) {
    const std::string valid_part = Json(text).dump(-1, ' ', false, Json::error_handler_t::ignore);
    return Json::parse(valid_part) == text;
}

// A uri becomes what tinygltf shall read: plain base64, or a place in `outside`.
CheckResult check_uri(Json& element,
                      const std::string& where,
                      SizeBytes size_bytes,
                      std::vector<OutsideBytes>& outside) {
    const std::string uri = element["uri"].get<std::string>();
    if (is_data_uri(uri)) {
        auto plain = plain_data_uri(uri, size_bytes);
        if (!plain)
            return wrong("{}: {}", where, plain.error());
        element["uri"] = std::move(*plain);
        return {};
    }
    std::optional<std::string> path = decode_uri(uri);
    if (!path || !is_utf8(*path))
        return wrong("{}: the uri {} is not valid", where, shown(uri));
    if (const auto checked = check_path(*path); !checked)
        return wrong("{}: {}", where, checked.error());
    element["uri"] = std::to_string(outside.size());
    element["name"] = *path;
    outside.push_back({where, std::move(path), size_bytes});
    return {};
}

CheckResult check_buffer(const Checker& check,
                         Json& buffer,
                         const std::string& where,
                         std::vector<OutsideBytes>& outside) {
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
    buffer["uri"] = std::to_string(outside.size());
    outside.push_back({where, std::nullopt, size_bytes});
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

CheckResult check_image(const Checker& check,
                        Json& image,
                        const std::string& where,
                        std::vector<OutsideBytes>& outside) {
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

CheckResult check_buffers(const Checker& check, std::vector<OutsideBytes>& outside) {
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
