// Figures of errors, by hand and by noise that is known.
#include "bakerd/picture/compare_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <string>

namespace drtv::test {
namespace {

using picture::CompareFigures;
using picture::ErrorSum;
using picture::Guesses;
using picture::Show;

Guesses<glm::vec3> both(float value) {
    return {glm::vec3(value), glm::vec3(value)};
}

TEST(ErrorSum, AddsUpByHand) {
    ErrorSum sum;
    sum.add(both(3), both(2));
    sum.add(both(1), {glm::vec3(3), glm::vec3(5)});
    EXPECT_EQ(sum.count, 6u);
    EXPECT_NEAR(sum.found, 3 * (3 + 1), 1e-9);
    EXPECT_NEAR(sum.truth, 3 * (2 + 4), 1e-9);
    EXPECT_NEAR(sum.squares, 3 * (1 * 1 + (-2) * (-4)), 1e-9);
}

TEST(ErrorSum, NoiseHasNoPartInTheSquares) {
    std::mt19937 random(11);
    std::normal_distribution<float> noise(0, 3);
    const auto noisy = [&](float value) {
        return Guesses<glm::vec3>{glm::vec3(value + noise(random)), glm::vec3(value + noise(random))};
    };
    ErrorSum sum;
    constexpr int pixels = 200'000;
    for (int n = 0; n < pixels; ++n)
        sum.add(noisy(n % 2 == 0 ? 11.0f : 9.5f), noisy(10));
    // Errors of 1 and -1/2 under noise of 3 on both sides: 18 / sqrt(200,000) is 0.04.
    EXPECT_NEAR(sum.squares / static_cast<double>(sum.count), (1 + 0.25) / 2, 0.15);
    EXPECT_NEAR((sum.found - sum.truth) / static_cast<double>(sum.count), 0.25, 0.05);
}

TEST(CompareTable, IsInPercentOfWhatIsShown) {
    CompareFigures figures;
    figures.by_part[0].add(both(5), both(4));
    figures.shown.add(both(9), both(8));
    figures.storage.add(both(9), both(9));
    figures.interpolation.add({glm::vec3(9), glm::vec3(7)}, both(8));
    figures.shading.add(both(10), both(8));
    std::istringstream lines(table_of(figures, Show::ambient));
    std::string line, text;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        for (std::string word; words >> word;)
            text += word + ' ';
        text += '\n';
    }
    EXPECT_NE(text.find("sky_direct 50.0 12.5 12.5 \n"), std::string::npos) << text;
    EXPECT_NE(text.find("all 100.0 12.5 12.5 \n"), std::string::npos) << text;
    EXPECT_NE(text.find("storage 0.0 0.0 \n"), std::string::npos) << text;
    EXPECT_NE(text.find("interpolation 0.0 - \n"), std::string::npos) << "noise alone: " << text;
    EXPECT_NE(text.find("shading 25.0 25.0 \n"), std::string::npos) << text;
    const std::string part = table_of(figures, Show::sky_bounce);
    EXPECT_EQ(part.find("sky_direct"), std::string::npos);
    EXPECT_NE(part.find("sky_bounce"), std::string::npos);
}

TEST(Shaded, NoiseDoesNotDecideWhatIsBelowZero) {
    BasisColours low{}, high{};
    low.fill({-4, -4, 1});
    high.fill({1, 5, 3});
    const auto all = shaded(RelightMode::accurate, Show::ambient, {low, high}, {0, 0, 1});
    // Means of -1.5, 0.5 and 2: the first is clamped on both sides, the others on none.
    EXPECT_EQ(all[0].x, 0);
    EXPECT_EQ(all[1].x, 0);
    EXPECT_LT(all[0].y, 0);
    EXPECT_GT(all[1].y, 0);
    const auto part = shaded(RelightMode::accurate, Show::local, {low, high}, {0, 0, 1});
    EXPECT_LT(part[0].x, 0);
}

}  // namespace
}  // namespace drtv::test
