// Everything that must come out the same on every CPU, as bytes: same_on_cpus.py runs this on three and
// compares.
//
//   cpu_bytes rays COUNT SEED OUT
//     hits of COUNT random rays and a tenth as many along axes, 8 bytes per ray
//   cpu_bytes bake OUT
//     sectors of a small map, with all that a sector can hold
//   cpu_bytes bake OUT MAP.glb SECTORS
//     so many sectors of a map, spread over it
//
// Sectors are baked with draft and with pc, both with few rays; the bytes of file and record follow each
// other.
#include "bakerd/bake/sector_file.h"
#include "bakerd/reuse/footprint_record.h"
#include "bakerd/reuse/rebake.h"
#include "settings/table.h"
#include "tests/bake/worlds.h"
#include "tests/bench/bench_world.h"
#include "tests/trace/scenes.h"

#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

namespace drtv::test {
namespace {

// FNV-1a over numbers bit by bit.
class BitHash {
  public:
    void add(std::uint32_t word) {
        for (int byte = 0; byte < 4; ++byte, word >>= 8)
            hash_ = (hash_ ^ (word & 0xFFu)) * 0x100000001B3u;
    }
    void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
    void add(const glm::vec3& v) {
        for (glm::length_t k = 0; k < 3; ++k)
            add(v[k]);
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325u;
};

Shape hills(std::mt19937& random) {
    constexpr std::uint32_t side = 33;
    Shape shape;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x)
            shape.positions.emplace_back(static_cast<float>(x) * 4 - 64, static_cast<float>(y) * 4 - 64,
                                         between(random, -9, -6));
    }
    for (std::uint32_t y = 0; y + 1 < side; ++y) {
        for (std::uint32_t x = 0; x + 1 < side; ++x) {
            const std::uint32_t k = y * side + x;
            shape.indices.insert(shape.indices.end(), {k, k + 1, k + side + 1, k, k + side + 1, k + side});
        }
    }
    return shape;
}

// Tiles of a kit on their lattice, things of every size and turn, copies in one place, a terrain that is no
// instance, leaves cut out by alpha. `place` is their middle.
std::vector<Thing> all_sorts(std::mt19937& random, const glm::vec3& place) {
    std::vector<Thing> things = {thing_of(hills(random))};
    for (int n = 0; n < 16; ++n) {
        things.push_back(thing_of(quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0})));
        things.back().world_from_shape =
            glm::translate(glm::dmat4(1), glm::dvec3(4 * (n % 4) - 8, 4 * (n / 4) - 8, 3));
    }
    for (int n = 0; n < 24; ++n) {
        const glm::dmat4 placed = random_placement(random, 25, n % 2 == 1);
        const Shape soup = triangle_soup(random, 12, 2);
        for (int copy = 0; copy < (n % 4 == 0 ? 2 : 1); ++copy) {
            things.push_back(thing_of(n % 3 == 0 ? box({-2, -2, -2}, {2, 2, 2}) : soup,
                                      glm::vec3(0.1f + 0.3f * static_cast<float>(copy))));
            things.back().world_from_shape = placed;
        }
    }
    for (int n = 0; n < 6; ++n) {
        things.push_back(
            thing_of(quad({-3, 0, -3}, {3, 0, -3}, {3, 0, 3}, {-3, 0, 3}), glm::vec3(0.5f), "vegetation"));
        things.back().material.texture = 0;
        things.back().material.mask_cutoff = 0.5;
        things.back().world_from_shape = random_placement(random, 20, false);
    }
    for (int n = 0; n < 6; ++n) {
        // Planks and panels, off their own origin.
        things.push_back(thing_of(box({40, -1, -1}, {42, 1, 1}), glm::vec3(0.6f)));
        things.back().world_from_shape = random_placement(random, 20, false) *
                                         glm::scale(glm::dmat4(1), glm::dvec3(n % 2 == 0 ? 6 : 0.1, 0.1, 3)) *
                                         glm::translate(glm::dmat4(1), glm::dvec3(-41, 0, 0));
    }
    for (Thing& thing : things)
        thing.world_from_shape = glm::translate(glm::dmat4(1), glm::dvec3(place)) * thing.world_from_shape;
    return things;
}

// With `all`, also what a surface looks like, and shadows: these take as long again.
std::uint64_t answers(const trace::Scene& scene, const trace::Ray& ray, bool all) {
    BitHash hash;
    if (const auto hit = scene.closest(ray)) {
        for (const float number : {hit->distance_m, hit->u, hit->v, hit->double_area_m2})
            hash.add(number);
        for (const std::uint32_t number :
             {hit->instance, hit->primitive, hit->triangle, hit->front ? 1u : 0u})
            hash.add(number);
        hash.add(hit->normal);
        if (!all)
            return hash.value();
        hash.add(scene.surface(*hit, 0.1f).albedo);
        // A ray that ends where the surface is.
        hash.add(scene.occluded({ray.origin, ray.direction, hit->distance_m}) ? 1u : 0u);
    }
    if (all)
        hash.add(scene.occluded(ray) ? 1u : 0u);
    return hash.value();
}

std::vector<std::uint64_t> answers_of_rays(int count, unsigned seed) {
    const trace::FloatMode float_mode;
    std::mt19937 random(seed);
    std::vector<std::uint64_t> found;
    constexpr int scenes = 2;
    for (int n = 0; n < scenes; ++n) {
        // Around the origin, and far out.
        const glm::vec3 place = n == 0 ? glm::vec3(0) : glm::vec3(3000, -2000, 100);
        const auto scene = scene_of(all_sorts(random, place));
        for (int k = 0; k < count / scenes; ++k) {
            const glm::vec3 origin(between(random, -40, 40), between(random, -40, 40),
                                   between(random, -8, 15));
            found.push_back(answers(*scene, {place + origin, random_direction(random), 200}, k % 8 == 0));
        }
        for (int k = 0; k < count / scenes / 10; ++k) {
            // Onto the lattice of the tiles, exactly along an axis or nearly so.
            glm::vec3 direction(0),
                origin(static_cast<float>(random() % 41u) - 20, static_cast<float>(random() % 41u) - 20,
                       static_cast<float>(random() % 21u) - 8);
            const auto axis = static_cast<glm::length_t>(random() % 3u);
            direction[axis] = random() % 2u == 0 ? 1.0f : -1.0f;
            if (random() % 2u == 0)
                direction[(axis + 1) % 3] = 1e-9f;
            origin[axis] = -direction[axis] * 60;
            found.push_back(answers(*scene, {place + origin, direction, 8192}, k % 8 == 0));
        }
        if (n > 0)
            continue;
        std::vector<placement::ColumnHit> column;
        for (int y = -20; y <= 20; ++y) {
            for (int x = -20; x <= 20; ++x) {
                BitHash hash;
                scene->column({x, y}, column);
                for (const placement::ColumnHit& hit : column)
                    hash.add(hit.z_m);
                hash.add(scene->distance_to_surface({x, y, 1}, 100));
                hash.add(static_cast<std::uint32_t>(
                    scene->crossings({glm::vec3(x, y, 20), glm::vec3(0.36f, 0.48f, -0.8f), 50})));
                found.push_back(hash.value());
            }
        }
        std::vector<trace::Ray> stream;
        std::vector<bool> hidden;
        for (int k = 0; k < 4096; ++k)
            stream.push_back(
                {glm::vec3(between(random, -20, 20), between(random, -20, 20), between(random, -6, 10)),
                 random_direction(random), between(random, 1, 40)});
        scene->occluded(stream, hidden);
        for (const bool is_hidden : hidden)
            found.push_back(is_hidden ? 1 : 0);
    }
    return found;
}

// Hills, blocks and trees over some sectors, lamps and a glowing block among them.
constexpr Clutter village{
    .low_m = -30, .high_m = 90, .ground_m = 120, .blocks = 12, .crowns = 30, .lamps = 6};

std::vector<settings::BakeSettings> settings_for(bool small) {
    settings::BakeSettings draft = settings::preset("draft")->bake, pc = settings::preset("pc")->bake;
    draft.rays = small ? 64 : 128;
    pc.rays = small ? 32 : 64;
    pc.local_rays = 32;
    if (small)
        draft.reach_m = pc.reach_m = 80;
    return {draft, pc};
}

std::vector<std::uint8_t> baked_bytes(bake::World& world, const std::vector<map::SectorCoordinate>& sectors,
                                      bool small) {
    std::vector<std::vector<std::uint8_t>> parts(sectors.size());
    tbb::parallel_for(std::size_t{0}, sectors.size(), [&](std::size_t n) {
        for (const settings::BakeSettings& settings : settings_for(small)) {
            const auto rebake = reuse::bake_and_record(world, sectors[n], settings).value();
            std::vector<std::string> warnings;
            const std::vector<std::uint8_t> file = bake::encode_sector(rebake.baked.sector, warnings).value(),
                                            record = reuse::encode_footprint(rebake.footprint);
            parts[n].insert(parts[n].end(), file.begin(), file.end());
            parts[n].insert(parts[n].end(), record.begin(), record.end());
        }
    });
    std::vector<std::uint8_t> all;
    for (const auto& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<map::SectorCoordinate> spread_over(const std::vector<map::SectorCoordinate>& sectors,
                                               std::size_t count) {
    std::vector<map::SectorCoordinate> chosen;
    for (std::size_t n = 0; n < count; ++n)
        chosen.push_back(sectors[(2 * n + 1) * sectors.size() / (2 * count)]);
    return chosen;
}

int write(const char* path, const void* bytes, std::size_t count) {
    std::ofstream out(path, std::ios::binary);
    out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    return out.good() ? 0 : 1;
}

}  // namespace
}  // namespace drtv::test

int main(int argc, char** argv) {
    using namespace drtv;
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "rays" && argc == 5) {
        const std::vector<std::uint64_t> found =
            test::answers_of_rays(std::atoi(argv[2]), static_cast<unsigned>(std::atoi(argv[3])));
        return test::write(argv[4], found.data(), found.size() * sizeof(found[0]));
    }
    if (what == "bake" && argc == 3) {
        const auto world = test::open_world(test::clutter(test::village));
        const std::vector<std::uint8_t> bytes = test::baked_bytes(*world, {{0, 0}, {1, 0}}, true);
        return test::write(argv[2], bytes.data(), bytes.size());
    }
    if (what == "bake" && argc == 5) {
        const auto world = bench::open_world(argv[3]);
        if (!world)
            return 1;
        const std::vector<std::uint8_t> bytes = test::baked_bytes(
            *world, test::spread_over(world->sectors(), static_cast<std::size_t>(std::atoi(argv[4]))), false);
        return test::write(argv[2], bytes.data(), bytes.size());
    }
    std::fprintf(stderr, "usage: cpu_bytes rays COUNT SEED OUT | bake OUT [MAP.glb SECTORS]\n");
    return 2;
}
