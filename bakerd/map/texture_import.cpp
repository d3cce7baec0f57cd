#include "bakerd/map/texture_import.h"

#include "bakerd/map/content_digest.h"
#include "bakerd/map/cos_sin.h"
#include "bakerd/map/texture_decode.h"
#include "bakerd/map/texture_filter.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace drtv::map {
namespace {

// Far beyond any picture; further out, coordinates would overflow.
constexpr float max_transform = 1e6f;

Wrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE)
        return Wrap::clamp;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)
        return Wrap::mirror;
    return Wrap::repeat;
}

glm::dvec2 pair_of(const tinygltf::Value& extension, const char* name, glm::dvec2 otherwise) {
    if (!extension.Has(name))
        return otherwise;
    const tinygltf::Value& pair = extension.Get(name);
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

// KHR_texture_transform: offset, rotation, scale, in that order around the texture's origin. The document's
// check saw to the types.
tl::expected<void, std::string> apply_texture_transform(const tinygltf::Value& extension, TextureView& view) {
    const glm::dvec2 offset = pair_of(extension, "offset", glm::dvec2(0));
    const glm::dvec2 scale = pair_of(extension, "scale", glm::dvec2(1));
    const double rotation = extension.Has("rotation") ? extension.Get("rotation").GetNumberAsDouble() : 0;
    const glm::dvec2 turned = cos_sin(rotation);
    view.u_from_uv = glm::vec3(glm::dvec3(turned.x * scale.x, turned.y * scale.y, offset.x));
    view.v_from_uv = glm::vec3(glm::dvec3(-turned.y * scale.x, turned.x * scale.y, offset.y));
    for (const glm::vec3& row : {view.u_from_uv, view.v_from_uv}) {
        for (glm::length_t k = 0; k < 3; ++k) {
            if (!(std::abs(row[k]) <= max_transform))
                return tl::unexpected(
                    fmt::format("KHR_texture_transform: {} is over the limit of {}", row[k], max_transform));
        }
    }
    return {};
}

}  // namespace

tl::expected<TextureView, std::string> TextureImporter::view_of(const TextureUse& use,
                                                                CoverageTest coverage) {
    if (use.index < 0)
        return TextureView{};
    const auto texture = texture_index(use.index, coverage);
    if (!texture)
        return tl::unexpected(texture.error());
    TextureView view;
    view.texture = *texture;
    const auto transform = use.extensions.find("KHR_texture_transform");
    if (transform == use.extensions.end())
        return view;
    if (auto applied = apply_texture_transform(transform->second, view); !applied)
        return tl::unexpected(applied.error());
    return view;
}

tl::expected<std::uint32_t, std::string> TextureImporter::texture_index(int index, CoverageTest coverage) {
    const tinygltf::Model& model = state_.document.model;
    const tinygltf::Texture& source = at_index(model.textures, index);
    if (source.source < 0)
        return tl::unexpected(fmt::format("texture {} has no PNG or JPEG source", index));
    Use use;
    use.image = source.source;
    use.coverage = coverage;
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler = at_index(model.samplers, source.sampler);
        use.wrap_u = wrap_of(sampler.wrapS);
        use.wrap_v = wrap_of(sampler.wrapT);
    }
    const auto known = decoded_.find(use);
    if (known != decoded_.end())
        return known->second;
    auto texture = decode(use.image);
    if (!texture)
        return tl::unexpected(texture.error());
    texture->wrap_u = use.wrap_u;
    texture->wrap_v = use.wrap_v;
    texture->coverage = coverage.coverage;
    texture->cutoff = coverage.cutoff;
    texture->digest = digest_texture(*texture);
    const std::uint32_t kept = keep(std::move(*texture));
    decoded_.emplace(use, kept);
    return kept;
}

tl::expected<Texture, std::string> TextureImporter::decode(int image_index) const {
    const tinygltf::Image& image = at_index(state_.document.model.images, image_index);
    const std::string& name = image.name;
    const std::string where = name.empty() ? fmt::format("image {}", image_index)
                                           : fmt::format("image {} ('{}')", image_index, name);
    if (image.image.empty())
        return tl::unexpected(fmt::format("{} has no bytes; is the file missing?", where));
    auto texture = decode_texture(image.image);
    if (!texture)
        return tl::unexpected(fmt::format("{}: {}", where, texture.error()));
    return texture;
}

std::uint32_t TextureImporter::keep(Texture texture) {
    std::vector<Texture>& textures = state_.map.textures;
    const std::size_t count_before = textures.size();
    const std::uint32_t kept = keep_once(std::move(texture), textures, state_.shared.textures);
    if (textures.size() > count_before)
        prefilter(textures.back());
    return kept;
}

}  // namespace drtv::map
