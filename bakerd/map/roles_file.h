// roles.json: what nodes are for, by their names, where an exporter drops the custom properties that say so.
#pragma once

#include "bakerd/map/file_source.h"
#include "bakerd/map/gltf_document.h"

#include <tiny_gltf.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

// Name patterns with the properties of the nodes that they match, in the order of the file:
//     { "tree_*": "vegetation", "hall": { "bake_role": "interior", "bake_spacing": 2 } }
// A pattern matches a whole name; * stands for any letters, ? for one, [abc] for one of these (fnmatch). A
// text alone is a bake_role.
class RolesFile {
  public:
    // The sentence names the pattern, but not the file.
    [[nodiscard]] static tl::expected<RolesFile, std::string> parse(std::string_view text);

    // Gives the nodes their properties: of several patterns that match the last one counts, property by
    // property. What a node says itself stays.
    void apply(tinygltf::Model& model);

    // The patterns that have matched nothing yet.
    [[nodiscard]] std::vector<std::string> unused() const;

  private:
    struct Rule {
        std::string pattern;
        tinygltf::Value::Object properties;
        bool used = false;
    };
    std::vector<Rule> rules_;
};

// The roles.json of each folder of a map. It counts for the documents that stand beside it.
class RolesFiles {
  public:
    // REQUIRES: it outlives this.
    explicit RolesFiles(const FileSource& files) : files_(files) {}

    // Gives the document's nodes their properties. The sentence names the file.
    [[nodiscard]] tl::expected<void, std::string> apply(GltfDocument& document);

    // A sentence for each pattern that no node's name matches.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    const FileSource& files_;
    std::map<std::string, std::optional<RolesFile>> known_;  // by path; nothing where there is no file
};

}  // namespace drtv::map
