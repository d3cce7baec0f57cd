// Textures of a glTF document on their way into the map: decoded once each, and seen as materials wear them.
#pragma once

#include "bakerd/map/import_state.h"
#include "bakerd/map/material_textures.h"

#include <compare>
#include <cstdint>
#include <map>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// What is there of a texture, as the material's alpha mode says.
struct CoverageTest {
    Coverage coverage = Coverage::whole;
    float cutoff = 0;  // of alpha; Coverage::cutoff only

    auto operator<=>(const CoverageTest&) const = default;
};

class TextureImporter {
  public:
    explicit TextureImporter(const ImportState& state) : state_(state) {}

    // The texture that is named, with its transform; a view of nothing when none is. The sentence names
    // neither file nor material; the caller does.
    [[nodiscard]] tl::expected<TextureView, std::string> view_of(const TextureUse& use,
                                                                 CoverageTest coverage);

  private:
    // A picture as materials use it: many may share one.
    struct Use {
        int image = 0;
        Wrap wrap_u = Wrap::repeat;
        Wrap wrap_v = Wrap::repeat;
        CoverageTest coverage;

        auto operator<=>(const Use&) const = default;
    };

    [[nodiscard]] tl::expected<std::uint32_t, std::string> texture_index(int index, CoverageTest coverage);
    [[nodiscard]] tl::expected<Texture, std::string> decode(int image_index) const;
    [[nodiscard]] std::uint32_t keep(Texture texture);

    const ImportState& state_;
    std::map<Use, std::uint32_t> decoded_;  // index into Map::textures
};

}  // namespace drtv::map
