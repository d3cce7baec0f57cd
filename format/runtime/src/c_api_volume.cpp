// The C face: relit probes and volumes.
#include "c_api.h"

using namespace drtv;

size_t drtv_relit_bytes(const drtv_limits* limits, int with_fade) {
    return Arena::bytes_of<drtv_relit>(1) + RelitProbes::memory_bytes(limits_of(*limits), with_fade != 0);
}

drtv_relit* drtv_relit_make(void* memory, size_t bytes, const drtv_limits* limits, int with_fade) {
    return make<drtv_relit>(
        memory, bytes, drtv_relit_bytes(limits, with_fade), limits_of(*limits), with_fade != 0);
}

int drtv_relight_needed(
    const drtv_set* set, drtv_sector_id sector, const drtv_light* shown, const drtv_light* now, float step) {
    const LoadedSector* loaded = set->find({sector.i, sector.j});
    const GameLight before(*shown);
    const GameLight after(*now);
    return loaded != nullptr && relight_needed(loaded->view, before.light, after.light, step) ? 1 : 0;
}

void drtv_relit_set_light(drtv_relit* relit, int shown, const drtv_light* light) {
    relit->set_light(shown_of(shown), GameLight(*light).light);
}

int drtv_relit_sector(drtv_relit* relit,
                      const drtv_set* set,
                      int shown,
                      drtv_sector_id sector,
                      const drtv_light* light,
                      const drtv_share* shares,
                      size_t share_count) {
    const LoadedSector* loaded = set->find({sector.i, sector.j});
    if (loaded == nullptr)
        return 0;
    relit->relight(shown_of(shown), *loaded, GameLight(*light).light, shares_of(shares, share_count));
    return 1;
}

void drtv_relit_set_fade(drtv_relit* relit, float share) {
    relit->set_fade(share);
}

void drtv_relit_finish_fade(drtv_relit* relit) {
    relit->finish_fade();
}

int drtv_relit_colours(const drtv_relit* relit,
                       const drtv_set* set,
                       drtv_sector_id sector,
                       uint32_t probe,
                       float basis_colours[4][3]) {
    const LoadedSector* loaded = set->find({sector.i, sector.j});
    if (loaded == nullptr || !relit->is_relit(*loaded) || probe >= loaded->view.probe_count)
        return 0;
    copy_colours(relit->colours(*loaded, probe), basis_colours);
    return 1;
}

void drtv_relit_fallback(const drtv_relit* relit, float basis_colours[4][3]) {
    copy_colours(relit->fallback(), basis_colours);
}

float drtv_relit_largest(const drtv_relit* relit, const drtv_set* set) {
    float largest = relit->largest_fallback();
    for (std::uint32_t slot = 0; slot < set->limits().sectors; ++slot) {
        const LoadedSector* sector = set->at(slot);
        if (sector != nullptr && relit->is_relit(*sector))
            largest = std::max(largest, relit->largest(*sector));
    }
    return largest;
}

drtv_volume_settings drtv_default_volume(void) {
    const VolumeSettings settings;
    drtv_volume_settings result{};
    std::copy_n(settings.size.begin(), 3, result.size);
    std::copy_n(settings.texel_m.begin(), 3, result.texel_m);
    result.borders = 1;
    return result;
}

size_t drtv_volume_bytes(const drtv_volume_settings* settings, const drtv_limits* limits) {
    const VolumeSettings asked = settings_of(*settings);
    if (!Volume::is_possible(asked))
        return 0;
    return Arena::bytes_of<drtv_volume>(1) + Volume::memory_bytes(asked, limits_of(*limits));
}

drtv_volume* drtv_volume_make(void* memory,
                              size_t bytes,
                              const drtv_volume_settings* settings,
                              const drtv_limits* limits) {
    return make<drtv_volume>(
        memory, bytes, drtv_volume_bytes(settings, limits), settings_of(*settings), limits_of(*limits));
}

float drtv_suggest_scale(float largest, float current) {
    return suggest_scale(largest, current);
}

void drtv_volume_set_scale(drtv_volume* volume, float scale) {
    if (scale > 0)
        volume->set_scale(scale);
}

void drtv_volume_update(drtv_volume* volume,
                        const drtv_set* set,
                        const drtv_relit* relit,
                        const double camera[3],
                        int write_all) {
    if (write_all != 0)
        volume->update_all(*set, *relit, double3(camera));
    else
        volume->update(*set, *relit, double3(camera));
}

const drtv_box* drtv_volume_dirty(const drtv_volume* volume, size_t* count) {
    const std::span<const TextureBox> boxes = volume->dirty();
    *count = boxes.size();
    return reinterpret_cast<const drtv_box*>(boxes.data());
}

void drtv_volume_texture_size(const drtv_volume* volume, int32_t size[3]) {
    const auto texture = volume->texture_size();
    std::copy_n(texture.begin(), 3, size);
}

const void* drtv_volume_texels(const drtv_volume* volume, uint32_t k, size_t* bytes) {
    if (k >= channel_count)
        return nullptr;
    const std::span<const std::byte> texels = volume->texels(k);
    *bytes = texels.size();
    return texels.data();
}

void drtv_volume_shader_inputs(const drtv_volume* volume, drtv_shader_inputs* inputs) {
    const VolumeShaderInputs from = volume->shader_inputs();
    *inputs = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        inputs->snapped_camera[axis] = from.snapped_camera[axis];
        inputs->uv_scale[axis] = from.uv_scale[axis];
        inputs->wrap_offset[axis] = from.wrap_offset[axis];
        inputs->uvw_multiply[axis] = from.uvw_multiply[axis];
        inputs->uvw_add[axis] = from.uvw_add[axis];
    }
    inputs->scale = from.scale;
}
