// A map as the farm keeps it: which files, by digest, and which of them to import. Itself a blob.
#pragma once

#include "bakerd/map/file_source.h"
#include "bakerd/store/blob_store.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::store {

struct ManifestFile {
    std::string path;  // relative, '/' between names
    Digest digest;
    std::int64_t size_bytes = 0;
};

struct Manifest {
    std::vector<ManifestFile> files;  // sorted by path
    std::vector<std::string> roots;   // sorted: their order does not matter to a map
};

// Sorts, and checks paths and roots; invalid_argument with a sentence.
[[nodiscard]] Result<Manifest> normalised(Manifest manifest);

// The bytes that name the map: equal for equal manifests.
[[nodiscard]] std::string encode_manifest(const Manifest& manifest);
[[nodiscard]] Result<Manifest> decode_manifest(std::string_view bytes);

// The manifest's files out of the store.
[[nodiscard]] map::FileSource manifest_source(const Manifest& manifest, BlobStore& store);

}  // namespace drtv::store
