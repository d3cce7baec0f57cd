// Transfer and sky visibility against closed forms: one wall, a disk overhead, leaves, blended sheets.
#include "bakerd/bake/convergence.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drtv::test {
namespace {

constexpr double sampling = 0.01;        // four standard errors of 8,192 paths on these scenes, absolute
constexpr double horizon_strip = 0.003;  // what of a lobe lies beyond the reach, where a plane ends

Json& material_json(GltfBuilder& b, int material) {
    return b.json["materials"][static_cast<std::size_t>(material)];
}

double upper_share(std::size_t basis) {
    return (1 + static_cast<double>(transfer_basis[basis][2])) / 2;
}

TEST(Transfer, EndlessWallSeesHalfTheSky) {
    constexpr double albedo = 0.8;
    GltfBuilder b;
    // In world axes the plane x = 0, front towards +x.
    b.place(quad({0, -3000, 3000}, {0, -3000, -3000}, {0, 3000, -3000}, {0, 3000, 3000}), "",
            b.add_material({.colour = {albedo, albedo, albedo, 1}}));
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {1, 0, 0}, 8192, 1);
    for (std::size_t basis = 0; basis < basis_count; ++basis) {
        const double hits = (1 - static_cast<double>(transfer_basis[basis][0])) / 2;
        EXPECT_NEAR(under_constant_sky(light, 0, basis), albedo / 2 * hits,
                    sampling * albedo / 2 + horizon_strip)
            << basis;
    }
}

// Ground and a wall that meet at right angles see half the sky and half of each other wherever on them: all
// bounces are known.
TEST(Transfer, EndlessCornerIsTheGeometricSeries) {
    constexpr double albedo = 0.8;
    for (const std::uint32_t bounces : {1u, 2u, 4u}) {
        GltfBuilder b;
        const int grey = b.add_material({.colour = {albedo, albedo, albedo, 1}});
        b.place(quad({0, 0, 3000}, {0, 0, -3000}, {0, 3000, -3000}, {0, 3000, 3000}), "", grey);
        b.place(quad({0, 0, -3000}, {0, 0, 3000}, {3000, 0, 3000}, {3000, 0, -3000}), "", grey);
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {2, 0, 1}, 8192, bounces);
        double radiance = 0;
        for (std::uint32_t k = 0; k < bounces; ++k)
            radiance = albedo * (0.5 + radiance / 2);
        // All of the lobe that looks down; of a lobe towards +x with half of the sky in view, what is not
        // sky.
        EXPECT_NEAR(under_constant_sky(light, 0, 3), radiance, sampling * radiance) << bounces;
        for (std::size_t basis = 0; basis < 3; ++basis) {
            const double sky = static_cast<double>(light.sky_visibility[basis]) * upper_share(basis);
            EXPECT_NEAR(under_constant_sky(light, 0, basis), radiance * (1 - sky),
                        sampling * radiance + horizon_strip)
                << bounces << " " << basis;
        }
    }
}

// What a disk on the axis hides of a lobe around b, when all of it lies above b's horizon: b.z sin^2 of its
// half angle.
TEST(Transfer, DiskOverheadHidesItsFormFactor) {
    for (const double radius : {0.5, 1.0, 1.3}) {
        GltfBuilder b;
        Shape disk;
        disk.positions.emplace_back(0, 2, 0);
        constexpr std::uint32_t corners = 200;
        for (std::uint32_t n = 0; n < corners; ++n) {
            const double angle = 2 * std::numbers::pi * n / corners;
            disk.positions.emplace_back(radius * std::cos(angle), 2, radius * std::sin(angle));
        }
        for (std::uint32_t n = 0; n < corners; ++n)
            disk.indices.insert(disk.indices.end(), {0, n + 1, (n + 1) % corners + 1});
        b.place(disk, "", b.add_material({.colour = {0, 0, 0, 1}}));
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {0, 0, 0}, 8192);
        for (std::size_t basis = 0; basis < 3; ++basis) {
            const double hidden =
                static_cast<double>(transfer_basis[basis][2]) * radius * radius / (radius * radius + 4);
            EXPECT_NEAR(light.sky_visibility[basis], 1 - hidden / upper_share(basis), sampling) << radius;
        }
    }
}

// Under an endless sheet of leaves that lets a share through, the sheet is a sky that much darker.
TEST(Transfer, LeavesLetLightThrough) {
    const auto under_sheet = [](const char* role, bool double_sided, double factor) {
        GltfBuilder b;
        const int leaf = b.add_material({.colour = {0.4f, 0.4f, 0.4f, 1}, .double_sided = double_sided});
        if (factor > 0)
            material_json(b, leaf)["extensions"]["KHR_materials_diffuse_transmission"] = {
                {"diffuseTransmissionFactor", factor}, {"diffuseTransmissionColorFactor", {0.5, 0.25, 0}}};
        b.place(ground(3000, 10), role, leaf);
        const auto world = open_world(b);
        return light_at(*world, {0, 0, 9}, 8192, 1);
    };
    const bake::ProbeLight leaves = under_sheet("vegetation", true, 0);
    EXPECT_NEAR(leaves.sky_visibility[0], 0, horizon_strip);
    for (std::size_t basis = 0; basis < 3; ++basis)
        EXPECT_NEAR(under_constant_sky(leaves, 0, basis), 0.2 * upper_share(basis),
                    sampling * 0.2 + horizon_strip);
    const bake::ProbeLight paper = under_sheet("static", false, 0.5);
    EXPECT_NEAR(under_constant_sky(paper, 0, 0), 0.25 * upper_share(0), sampling * 0.25 + horizon_strip);
    EXPECT_NEAR(under_constant_sky(paper, 1, 0), 0.125 * upper_share(0), sampling * 0.125 + horizon_strip);
    EXPECT_NEAR(under_constant_sky(under_sheet("vegetation", false, 0), 0, 0), 0, horizon_strip);  // wood
    EXPECT_NEAR(under_constant_sky(under_sheet("static", true, 0), 0, 0), 0, horizon_strip);       // a board
}

// A leaf of two one-sided skins lets as much through as one of two sides.
TEST(Transfer, TwinLeavesLetLightThroughToo) {
    GltfBuilder b;
    const int leaf = b.add_material({.colour = {0.4f, 0.4f, 0.4f, 1}, .mask_cutoff = 0.5});
    Shape both = ground(3000, 10);
    const std::vector<std::uint32_t> once = both.indices;
    for (std::size_t n = 0; n + 2 < once.size(); n += 3)
        both.indices.insert(both.indices.end(), {once[n + 2], once[n + 1], once[n]});
    b.place(both, "vegetation", leaf);
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {0, 0, 9}, 8192, 1);
    for (std::size_t basis = 0; basis < 3; ++basis)
        EXPECT_NEAR(under_constant_sky(light, 0, basis), 0.2 * upper_share(basis),
                    sampling * 0.2 + horizon_strip);
}

// From above, leaves send back what they do not let through.
TEST(Transfer, TransmissionLeavesTheRestToReflection) {
    GltfBuilder b;
    const int leaf = b.add_material({.colour = {0.6f, 0.6f, 0.6f, 1}});
    material_json(
        b, leaf)["extensions"]["KHR_materials_diffuse_transmission"] = {{"diffuseTransmissionFactor", 0.25}};
    b.place(ground(3000), "", leaf);
    const auto world = open_world(b);
    EXPECT_NEAR(under_constant_sky(light_at(*world, {0, 0, 1}, 8192, 1), 0, 3), 0.45, sampling * 0.45);
}

TEST(Transfer, BlendedSheetIsThereWithItsAlpha) {
    for (const float alpha : {0.0f, 0.25f, 0.75f, 1.0f}) {
        GltfBuilder b;
        const int glass = b.add_material({.colour = {0, 0, 0, alpha}, .double_sided = true});
        material_json(b, glass)["alphaMode"] = "BLEND";
        b.place(ground(3000, 10), "", glass);
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {0, 0, 9}, 8192);
        // Coins of some 6,000 rays: four standard errors.
        const double coins = alpha == 0 || alpha == 1 ? horizon_strip : 4 * std::sqrt(0.25 / 4000);
        for (std::size_t basis = 0; basis < 3; ++basis)
            EXPECT_NEAR(light.sky_visibility[basis], 1 - static_cast<double>(alpha), coins);
    }
}

// A checkerboard's bounce is that of its mean, from near and far and whatever its size.
TEST(Transfer, TexturesAverageToTheirMean) {
    for (const std::uint32_t size : {2u, 64u, 512u}) {
        Picture board{size, size, {}};
        for (std::uint32_t n = 0; n < size * size; ++n) {
            const std::uint8_t shade = (n % size + n / size) % 2 == 0 ? 255 : 0;
            board.rgba.insert(board.rgba.end(), {shade, shade, shade, 255});
        }
        GltfBuilder b;
        Shape plane = ground(500);
        for (glm::vec2& uv : plane.uvs)
            uv *= 1000.0f;  // a board a metre
        b.place(plane, "",
                b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}, .texture = b.add_texture(board)}));
        const auto world = open_world(b);
        for (const float height : {2.0f, 30.0f})
            EXPECT_NEAR(under_constant_sky(light_at(*world, {0.3f, 0.7f, height}, 8192, 1), 0, 3), 0.4,
                        3 * sampling * 0.4)
                << size << " " << height;
    }
}

// Walls, a block and a roof on the ground.
GltfBuilder yard() {
    GltfBuilder b;
    const int grey = b.add_material({.colour = {0.7f, 0.7f, 0.7f, 1}, .double_sided = true});
    b.place(ground(40), "", grey);
    b.place(box({-6, 0, -1}, {-4, 5, 3}), "", grey);
    b.place(box({2, 0, 1}, {5, 2, 2}), "", grey);
    b.place(box({-3, 3, -8}, {3, 3.2f, 0}), "", grey);
    return b;
}

// Blocks tell the truth of their own spread, against many probes whose answer is known: the reported error is
// right in the mean square within a third.
TEST(Convergence, ReportedErrorIsTheTrueOne) {
    GltfBuilder b = yard();
    const auto world = open_world(b);
    const bake::ProbeLight truth = light_at(*world, {0.004f, 0.007f, 1.5f}, 262144);
    for (const std::uint32_t rays : {256u, 2048u}) {
        double reported = 0, actual = 0;
        for (int n = 0; n < 40; ++n) {
            // Millimetres apart: all these have nearly one truth, but samples of their own.
            const glm::vec3 place(static_cast<float>(n % 5) * 0.002f, static_cast<float>(n / 5) * 0.002f,
                                  1.5f);
            const bake::ProbeLight light = light_at(*world, place, rays);
            double square = 0, mean = 0;
            for (std::size_t basis = 0; basis < basis_count; ++basis) {
                const double open = basis < 3 ? upper_share(basis) : 0;
                const auto relit = [&](const bake::ProbeLight& l) {
                    return under_constant_sky(l, 0, basis) +
                           static_cast<double>(l.sky_visibility[basis]) * open;
                };
                square += std::pow(relit(light) - relit(truth), 2) / basis_count;
                mean += relit(truth) / basis_count;
            }
            actual += square / (mean * mean);
            reported += std::pow(static_cast<double>(light.error), 2);
        }
        EXPECT_NEAR(std::sqrt(reported / actual), 1, 0.2) << rays;
    }
}

// The same of each part on its own scale; of a lamp at night too, which the floor of the error above hides.
TEST(Convergence, QualityOfEachPartIsTheTrueOne) {
    GltfBuilder b = yard();
    const auto lamp = [&](double candela, std::optional<std::string> group) {
        b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", candela}}),
                    .translation = glm::dvec3(3.5, 1.2, 3),
                    .light_group = std::move(group)});
    };
    lamp(100, std::nullopt);
    lamp(5, "dim");
    const auto world = open_world(b);
    // One number of it a row, over all of which one error is told.
    const auto parts = [](const bake::ProbeLight& light) {
        std::array<std::vector<double>, 4> numbers;
        for (std::size_t basis = 0; basis < basis_count; ++basis) {
            numbers[0].push_back(under_constant_sky(light, 0, basis));
            if (basis < 3)
                numbers[1].push_back(static_cast<double>(light.sky_visibility[basis]));
            numbers[2].push_back(static_cast<double>(light.static_irradiance[0][basis]));
            numbers[3].push_back(static_cast<double>(light.groups.at(0).irradiance[0][basis]));
        }
        return numbers;
    };
    const auto truth = parts(light_at(*world, {0.004f, 0.007f, 1.5f}, 262144));
    std::array<double, 4> reported{}, actual{};
    for (int n = 0; n < 40; ++n) {
        const glm::vec3 place(static_cast<float>(n % 5) * 0.002f, static_cast<float>(n / 5) * 0.002f, 1.5f);
        const bake::ProbeLight light = light_at(*world, place, 1024);
        const std::array<float, 4> errors = {light.transfer_error, light.visibility_error, light.static_error,
                                             light.groups.at(0).error};
        const auto found = parts(light);
        for (std::size_t part = 0; part < 4; ++part) {
            double square = 0, mean = 0;
            for (std::size_t k = 0; k < truth[part].size(); ++k) {
                square += std::pow(found[part][k] - truth[part][k], 2);
                mean += truth[part][k];
            }
            const auto count = static_cast<double>(truth[part].size());
            actual[part] += square / count / std::pow(mean / count, 2);
            reported[part] += std::pow(static_cast<double>(errors[part]), 2);
        }
    }
    for (std::size_t part = 0; part < 4; ++part)
        EXPECT_NEAR(std::sqrt(reported[part] / actual[part]), 1, 0.35) << part;
}

TEST(Convergence, ErrorAskedForIsReachedWithFewerPaths) {
    GltfBuilder b;
    b.place(ground(40), "", b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}}));
    b.place(box({-6, 0, -1}, {-4, 5, 3}), "", b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}}));
    const auto world = open_world(b);
    const bake::ProbeLight easy = light_at(*world, {20, 20, 1}, 65536, 3, 0.01f),
                           hard = light_at(*world, {-3.5f, 0.5f, 0.3f}, 65536, 3, 0.002f),
                           budget = light_at(*world, {-3.5f, 0.5f, 0.3f}, 1024, 3, 0.0001f);
    EXPECT_LE(easy.error, 0.01f);
    EXPECT_LE(hard.error, 0.002f);
    EXPECT_LT(easy.paths, hard.paths);
    EXPECT_EQ(budget.paths, 1024u);
    EXPECT_GT(budget.error, 0.0001f);
    EXPECT_TRUE(budget.budget_ended);
    EXPECT_FALSE(easy.budget_ended || hard.budget_ended);
    EXPECT_FALSE(light_at(*world, {20, 20, 1}, 256).budget_ended) << "no error was asked for";
}

}  // namespace
}  // namespace drtv::test
