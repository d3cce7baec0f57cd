#include "bakerd/map/file_kind.h"

#include <algorithm>
#include <array>

namespace drtv::map {
namespace {

using namespace std::string_view_literals;

struct Kind {
    std::string_view beginning;
    std::string_view what;
};

constexpr std::array<Kind, 23> kinds = {
    {{"BLENDER"sv, "a Blender file: export it as glTF 2.0 (File > Export)"sv},
     {"Kaydara FBX Binary"sv, "an FBX file: convert it to glTF 2.0"sv},
     {"; FBX"sv, "an FBX file: convert it to glTF 2.0"sv},
     {"PXR-USDC"sv, "a USD file: convert it to glTF 2.0"sv},
     {"#usda"sv, "a USD file: convert it to glTF 2.0"sv},
     {"PK\x03\x04"sv, "a ZIP archive: unpack it, and name the glTF file in it"sv},
     {"\x1f\x8b"sv, "compressed with gzip: unpack it first"sv},
     {"\x28\xb5\x2f\xfd"sv, "compressed with Zstandard, as Blender may save: export it as glTF 2.0"sv},
     {"7z\xbc\xaf"sv, "a 7-Zip archive: unpack it, and name the glTF file in it"sv},
     {"version https://git-lfs"sv, "a pointer of Git LFS, not the file itself: run git lfs pull"sv},
     {"DRTV"sv, "a sector file, not a map"sv},
     {"\x89PNG"sv, "a picture, not a map"sv},
     {"\xff\xd8\xff"sv, "a picture, not a map"sv},
     {"DDS "sv, "a picture, not a map"sv},
     {"ply\n"sv, "a PLY file: convert it to glTF 2.0"sv},
     {"ply\r"sv, "a PLY file: convert it to glTF 2.0"sv},
     {"solid "sv, "an STL file: convert it to glTF 2.0"sv},
     {"mtllib "sv, "an OBJ file: convert it to glTF 2.0"sv},
     {"# Blender"sv, "an OBJ or MTL file: export it as glTF 2.0"sv},
     {"\xff\xfe"sv, "text in UTF-16: save it as UTF-8"sv},
     {"\xfe\xff"sv, "text in UTF-16: save it as UTF-8"sv},
     {"<!DOCTYPE"sv, "a web page: was the download refused?"sv},
     {"<html"sv, "a web page: was the download refused?"sv}}};

}  // namespace

std::string_view foreign_kind(std::string_view bytes) {
    const auto* found =
        std::ranges::find_if(kinds, [&](const Kind& kind) { return bytes.starts_with(kind.beginning); });
    if (found != kinds.end())
        return found->what;
    constexpr std::size_t head = 1024;
    if (bytes.starts_with("<?xml") && bytes.substr(0, head).find("<COLLADA") != std::string_view::npos)
        return "a COLLADA file: convert it to glTF 2.0";
    return "";
}

}  // namespace drtv::map
