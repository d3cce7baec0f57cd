// How a glTF document names the files beside it. One rule for those who upload the files and those who read
// them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map_files {

// Whether the uri holds its bytes itself.
[[nodiscard]] bool is_data_uri(std::string_view uri);

// The files of the map that the uri may mean, the likeliest first, as paths relative to the map's folder:
// the one that its decoded name leads to, and then, where they differ, its name as it is written, since some
// exporters do not encode. `document` is the path of the glTF file itself. Dot segments are removed as RFC
// 3986 (5.2.4) says, empty ones too. Fails with the end of a sentence where the decoded name leads to no file
// of the map's folder: "the path '../x' leaves the map's folder".
[[nodiscard]] tl::expected<std::vector<std::string>, std::string> files_named(std::string_view document,
                                                                              std::string_view uri);

// Fails for a path that is not one of those above. "the path '/x' is absolute, it must lie in the map's
// folder"
[[nodiscard]] tl::expected<void, std::string> check_path(std::string_view path);

// Where the roles of a document's nodes may stand, beside it: "west/roles.json" for "west/tile.glb".
[[nodiscard]] std::string roles_path(std::string_view document);

// Whether a file of this name is a glTF document, by its ending: .gltf or .glb, in upper or lower case.
[[nodiscard]] bool is_document_name(std::string_view name);

}  // namespace drtv::map_files
