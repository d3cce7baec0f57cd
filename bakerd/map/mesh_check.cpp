#include "bakerd/map/mesh_check.h"

#include "bakerd/map/extension_check.h"

namespace drtv::map {
namespace {

bool has_buffer_view(const Checker& check, const Json& accessor_index) {
    return check.element("accessors", accessor_index).contains("bufferView");
}

// Some files use a compression without requiring it, and have nothing else: their accessors would read as
// zeros.
Failure check_compression(const Checker& check, Json& primitive, const std::string& where) {
    constexpr const char* draco = "KHR_draco_mesh_compression";
    if (extension_of(primitive, draco) == nullptr)
        return {};
    const Json& attributes = primitive["attributes"];
    if (attributes.contains("POSITION") && has_buffer_view(check, attributes["POSITION"]))
        return {};
    return fmt::format("{} is compressed by {}, which is not supported", where, draco);
}

Failure check_primitive(const Checker& check, Json& primitive, const std::string& where) {
    const std::initializer_list<Property> members = {required(object_at("attributes")),
                                                     reference_at("indices", "accessors"),
                                                     reference_at("material", "materials"),
                                                     index_at("mode"),
                                                     object_at("extensions")};
    if (Failure failure = check.properties(primitive, where, members))
        return failure;
    if (Failure failure = check.accessors_of(primitive["attributes"], where))
        return failure;
    if (Failure failure = check_compression(check, primitive, where))
        return failure;
    const auto indices = primitive.find("indices");
    if (indices != primitive.end() && !has_buffer_view(check, *indices))
        return fmt::format("{}: its indices, accessor {}, have no bufferView", where, shown(*indices));
    primitive.erase("targets");
    return {};
}

Failure check_mesh(const Checker& check, Json& mesh, const std::string& where) {
    if (!mesh.is_object())
        return fmt::format("{} is not an object", where);
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array())
        return fmt::format("{}: primitives must be an array", where);
    for (std::size_t n = 0; n < primitives->size(); ++n) {
        const std::string inner = fmt::format("{}, primitive {}", where, n);
        if (Failure failure = check_primitive(check, (*primitives)[n], inner))
            return failure;
    }
    return {};
}

}  // namespace

Failure check_meshes(const Checker& check) {
    return check.each("meshes", "mesh", [&](Json& mesh, const std::string& where) {
        return check_mesh(check, mesh, where);
    });
}

}  // namespace drtv::map
