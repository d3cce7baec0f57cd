#include "bakerd/picture/compare_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace drtv::picture {
namespace {

double count_of(const ErrorSum& sum) {
    return static_cast<double>(std::max<std::size_t>(sum.count, 1));
}

// `percent`: by which a mean becomes percent of the mean of all light. Where noise outweighs the errors,
// their square may come out below 0: then nothing is said.
std::string errors(const ErrorSum& sum, double percent) {
    const double count = count_of(sum);
    const double square = sum.squares / count;
    const std::string rms = square < 0 ? "-" : fmt::format("{:.1f}", percent * std::sqrt(square));
    return fmt::format("{:>9.1f}{:>9}\n", percent * (sum.found - sum.truth) / count, rms);
}

std::string row(std::string_view name, const ErrorSum& sum, double percent) {
    return fmt::format("{:<16}{:>9.1f}{}", name, percent * sum.truth / count_of(sum), errors(sum, percent));
}

std::string cause(std::string_view name, const ErrorSum& sum, double percent) {
    return fmt::format("{:<16}{:>9}{}", name, "", errors(sum, percent));
}

}  // namespace

void ErrorSum::add(const Guesses<glm::vec3>& guesses, const Guesses<glm::vec3>& truths) {
    const glm::dvec3 first = glm::dvec3(guesses[0]) - glm::dvec3(truths[0]);
    const glm::dvec3 second = glm::dvec3(guesses[1]) - glm::dvec3(truths[1]);
    const glm::dvec3 shown(mean_of(guesses));
    const glm::dvec3 right(mean_of(truths));
    for (glm::length_t c = 0; c < 3; ++c) {
        found += shown[c];
        truth += right[c];
        squares += first[c] * second[c];
    }
    count += 3;
}

void ErrorSum::add(const ErrorSum& other) {
    found += other.found;
    truth += other.truth;
    squares += other.squares;
    count += other.count;
}

void CompareFigures::add(const CompareFigures& other) {
    for (std::size_t n = 0; n < by_part.size(); ++n)
        by_part[n].add(other.by_part[n]);
    shown.add(other.shown);
    storage.add(other.storage);
    interpolation.add(other.interpolation);
    shading.add(other.shading);
}

std::string table_of(const CompareFigures& figures, Show shown) {
    constexpr double min_mean = 1e-30;
    const double percent = 100 / std::max(figures.shown.truth / count_of(figures.shown), min_mean);
    std::string text = "ambient light of the surfaces in sight, beside path tracing\n";
    text += fmt::format("{:<16}{:>9}{:>9}{:>9}\n", "part", "share %", "bias %", "rms %");
    for (std::size_t n = 0; shown == Show::ambient && n < compared_parts.size(); ++n)
        text += row(name_of(compared_parts[n]), figures.by_part[n], percent);
    text += row(shown == Show::ambient ? "all" : name_of(shown), figures.shown, percent);
    text += "causes, each beside the next nearer to the truth\n";
    text += cause("storage", figures.storage, percent);
    text += cause("interpolation", figures.interpolation, percent);
    text += cause("shading", figures.shading, percent);
    return text;
}

}  // namespace drtv::picture
