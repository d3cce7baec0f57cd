// Equal distances are decided by a rule: not by the order of the map, what else is there, or the thread.
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <bit>
#include <thread>
#include <tuple>

namespace drtv::test {
namespace {

using trace::Ray;

// All that an answer says, bit by bit.
using Answer = std::tuple<bool, std::uint32_t, std::uint32_t, std::uint32_t, bool, std::uint32_t,
                          std::uint32_t, std::uint32_t, map::Digest>;

std::vector<Answer> answers(const trace::Scene& scene, const std::vector<Ray>& rays) {
    const trace::FloatMode mode;
    std::vector<Answer> result;
    const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
    for (const Ray& ray : rays) {
        const auto hit = scene.closest(ray);
        if (hit)
            result.emplace_back(true, bits(hit->distance_m), bits(hit->u), bits(hit->v), hit->front,
                                bits(hit->normal.x), bits(hit->normal.y),
                                bits(scene.surface(*hit, 0).albedo.x), scene.object_of(*hit).digest);
        else
            result.emplace_back();
    }
    return result;
}

// Copies at one place that differ in colour, squares in one plane cut differently, and a turned soup twice.
std::vector<Thing> tied_things() {
    std::vector<Thing> things;
    std::mt19937 random(21);
    const Shape soup = triangle_soup(random, 60, 3);
    const glm::dmat4 turned = random_placement(random, 4, true);
    for (const float shade : {0.1f, 0.3f, 0.5f, 0.7f}) {
        things.push_back(thing_of(level_square(20, -6), glm::vec3(shade)));
        things.push_back(thing_of(soup, glm::vec3(shade)));
        things.back().world_from_shape = turned;
        things.push_back(thing_of(box({3, 3, -2}, {7, 7, 2}), glm::vec3(shade)));
    }
    things.push_back(thing_of(level_square(20, -6), glm::vec3(0.1f)));  // a true duplicate
    Shape other_cut = level_square(20, -6);
    other_cut.indices = {1, 2, 3, 1, 3, 0};
    things.push_back(thing_of(other_cut, glm::vec3(0.9f)));
    things.push_back(thing_of(level_square(10, -6), glm::vec3(0.8f)));
    return things;
}

std::vector<Ray> many_rays() {
    std::mt19937 random(4);
    std::vector<Ray> rays;
    for (int n = 0; n < 20000; ++n) {
        const glm::vec3 origin(between(random, -15, 15), between(random, -15, 15), between(random, -5, 12));
        rays.push_back({origin, random_direction(random), 500});
        // At the lattice of the squares' edges and diagonals.
        const glm::vec3 target(static_cast<float>(random() % 5u) * 5 - 10,
                               static_cast<float>(random() % 5u) * 5 - 10, -6);
        rays.push_back({origin, glm::normalize(target - origin), 500});
        rays.push_back({{target.x, target.y, origin.z}, {0, 0, -1}, 500});
    }
    return rays;
}

TEST(Ties, OrderOfTheMapDoesNotMatter) {
    std::vector<Thing> things = tied_things();
    const std::vector<Ray> rays = many_rays();
    const std::vector<Answer> before = answers(*scene_of(things), rays);
    EXPECT_GT(std::count_if(before.begin(), before.end(), [](const Answer& a) { return std::get<0>(a); }),
              20000);
    std::mt19937 random(6);
    for (int n = 0; n < 4; ++n) {
        std::shuffle(things.begin(), things.end(), random);
        EXPECT_TRUE(answers(*scene_of(things), rays) == before) << "shuffle " << n;
    }
}

TEST(Ties, FarObjectsDoNotMatter) {
    std::vector<Thing> things = tied_things();
    const std::vector<Ray> rays = many_rays();
    const std::vector<Answer> before = answers(*scene_of(things), rays);
    std::mt19937 random(8);
    for (const int far : {1, 7, 60}) {
        std::vector<Thing> more = things;
        for (int n = 0; n < far; ++n) {
            more.push_back(thing_of(triangle_soup(random, 9, 2), glm::vec3(0.01f * static_cast<float>(n))));
            more.back().world_from_shape =
                glm::translate(glm::dmat4(1), glm::dvec3(2000 + 40 * n, 1500 - 90 * n, 100));
        }
        EXPECT_TRUE(answers(*scene_of(more), rays) == before) << far << " far objects";
    }
}

// Copies share a mesh: what is far away and stretched must not change how a hit on the copy at hand is
// judged.
TEST(Ties, StretchedCopiesFarAwayDoNotMatter) {
    std::vector<Thing> things = tied_things();
    std::mt19937 random(12);
    std::vector<Ray> rays = many_rays();
    for (int n = 0; n < 20000; ++n) {
        // Grazing the squares.
        const glm::vec3 target(between(random, -19, 19), between(random, -19, 19), -6),
            from(between(random, -60, 60), between(random, -60, 60), between(random, -5.99f, -5));
        rays.push_back({from, glm::normalize(target - from), 500});
    }
    const std::vector<Answer> before = answers(*scene_of(things), rays);
    const std::size_t count = things.size();
    for (std::size_t n = 0; n < count; ++n) {
        things.push_back(things[n]);
        things.back().world_from_shape =
            glm::translate(glm::dmat4(1), glm::dvec3(2500, 100 * static_cast<double>(n), 0)) *
            glm::scale(glm::dmat4(1), glm::dvec3(1, n % 2 == 0 ? 12 : 1, 0.05));
    }
    const auto map = map_of(things);
    EXPECT_LT(map->meshes.size(), count);
    EXPECT_TRUE(answers(*scene_of(map), rays) == before);
}

TEST(Ties, NearObjectsOffTheRaysDoNotMatter) {
    // They change the BVH right where the ties are.
    std::vector<Thing> things = tied_things();
    std::vector<Ray> rays;
    for (const Ray& ray : many_rays()) {
        if (ray.origin.z < 8 && ray.direction.z < 0)
            rays.push_back(ray);
    }
    const std::vector<Answer> before = answers(*scene_of(things), rays);
    for (int n = 0; n < 30; ++n) {
        const float x = static_cast<float>(n) - 15;
        things.push_back(thing_of(box({x, -15, 9}, {x + 0.7f, 15, 9.5f})));
        things.push_back(thing_of(box({x, -15, -9}, {x + 0.7f, 15, -7})));
    }
    // What goes past the squares' rims may meet the new ones.
    const std::vector<Answer> after = answers(*scene_of(things), rays);
    std::size_t compared = 0;
    for (std::size_t n = 0; n < rays.size(); ++n) {
        if (!std::get<0>(before[n]))
            continue;
        ++compared;
        ASSERT_TRUE(after[n] == before[n]) << "ray " << n;
    }
    EXPECT_GT(compared, 10000u);
}

TEST(Ties, ThreadsAndRebuildsAgree) {
    const std::vector<Thing> things = tied_things();
    const std::vector<Ray> rays = many_rays();
    const auto map = map_of(things);
    const auto scene = scene_of(map);
    const std::vector<Answer> before = answers(*scene, rays);
    std::vector<std::vector<Answer>> found(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 4; ++t)
        threads.emplace_back([&, t] { found[t] = answers(t < 2 ? *scene : *scene_of(map), rays); });
    for (std::thread& thread : threads)
        thread.join();
    for (const auto& answer : found)
        EXPECT_TRUE(answer == before);
}

TEST(Ties, SmallerDigestWins) {
    const auto map = map_of(std::vector<Thing>{thing_of(level_square(5), glm::vec3(0.2f)),
                                               thing_of(level_square(5), glm::vec3(0.4f)),
                                               thing_of(level_square(5), glm::vec3(0.6f))});
    const auto scene = scene_of(map);
    for (const float x : {-5.0f, -2.0f, 0.0f, 1.5f, 3.0f}) {
        const auto hit = scene->closest({{x, 1.5f, 2}, {0, 0, -1}, 9});
        ASSERT_TRUE(hit);
        EXPECT_EQ(scene->object_of(*hit).digest, map->objects[0].digest);
    }
}

// A thing of two one-sided skins in one place shows its front to both sides, whichever way it was modelled
// first.
TEST(Ties, TwinTrianglesHaveTwoFronts) {
    for (const bool up_first : {true, false}) {
        const Shape up = level_square(5, 1.25f);
        Shape both = up;
        both.indices.clear();
        for (std::size_t t = 0; t < up.indices.size(); t += 3) {
            const std::uint32_t a = up.indices[t], b = up.indices[t + 1], c = up.indices[t + 2];
            if (up_first)
                both.indices.insert(both.indices.end(), {a, b, c, c, b, a});
            else
                both.indices.insert(both.indices.end(), {b, a, c, b, c, a});
        }
        Thing thing = thing_of(both, glm::vec3(0.5f));
        std::mt19937 random(9);
        thing.world_from_shape = random_placement(random, 20, false);
        const auto scene = scene_of(std::vector<Thing>{thing});
        int fronts = 0;
        for (int n = 0; n < 4000; ++n) {
            const glm::dvec3 target(between(random, -4, 4), between(random, -4, 4), 1.25),
                from(between(random, -9, 9), between(random, -9, 9), between(random, -9, 9));
            const glm::vec3 origin(thing.world_from_shape * glm::dvec4(from, 1)),
                to(thing.world_from_shape * glm::dvec4(target, 1));
            const auto hit = scene->closest({origin, glm::normalize(to - origin), 100});
            ASSERT_TRUE(hit);
            EXPECT_TRUE(hit->front);
            EXPECT_FALSE(scene->surface(*hit, 0).absorbs);
            EXPECT_NEAR(scene->surface(*hit, 0).albedo.x, 0.5f, 1e-6f);
            fronts += hit->front ? 1 : 0;
        }
        EXPECT_EQ(fronts, 4000);
    }
}

}  // namespace
}  // namespace drtv::test
