// What shaders under test are given, as files of numbers.
#pragma once

#include <drtv/tile_texture.h>
#include <drtv/volume.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

namespace drtv::test {

template <class Value>
inline void write_file(const std::filesystem::path& path, std::span<const Value> values) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size_bytes()));
}

class Numbers {
  public:
    void add(float number) { numbers_.push_back(number); }
    template <class Vector>
    void add_all(const Vector& vector) {
        for (const float number : vector)
            add(number);
    }
    void add(const BasisColours& colours) {
        for (const Float3& colour : colours)
            add_all(colour);
    }
    // As the harness makes DrtvVolume of them.
    void add(const Volume& volume) {
        const VolumeShaderInputs inputs = volume.shader_inputs();
        const VolumeSettings& settings = volume.settings();
        for (const std::int32_t size : settings.size)
            add(static_cast<float>(size));
        add_all(inputs.uv_scale);
        add_all(inputs.wrap_offset);
        add_all(inputs.uvw_multiply);
        add_all(inputs.uvw_add);
        add(inputs.scale);
        add(static_cast<float>(settings.encoding));
        add(settings.atlas ? 1 : 0);
    }
    // As the harness makes DrtvTiles.
    void add(const TileShaderInputs& tiles) {
        add_all(tiles.camera);
        add(tiles.columns);
        add(tiles.camera_z);
    }
    [[nodiscard]] std::span<const float> all() const { return numbers_; }

  private:
    std::vector<float> numbers_;
};

}  // namespace drtv::test
