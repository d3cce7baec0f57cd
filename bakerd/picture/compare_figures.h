// How far off light is, added up over a picture.
#pragma once

#include "bakerd/picture/show.h"
#include "bakerd/picture/true_probes.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <string>

namespace drtv::picture {

inline constexpr std::array<Show, 5> compared_parts = {
    Show::sky_direct, Show::sky_bounce, Show::sun_bounce, Show::static_light, Show::local};

struct ErrorSum {
    double found = 0, truth = 0, squares = 0;
    std::size_t count = 0;  // of channels

    // Independent guesses: their noise has no part in the mean of the product of errors.
    void add(const Guesses<glm::vec3>& guesses, const Guesses<glm::vec3>& truths);
    void add(const ErrorSum& other);
};

struct CompareFigures {
    std::array<ErrorSum, compared_parts.size()> by_part;
    ErrorSum shown;  // what the picture shows: one part, or all
    // Of what is shown.
    ErrorSum storage;        // what the files hold beside true colours at the same probes
    ErrorSum interpolation;  // these beside true colours at the place itself
    ErrorSum shading;        // and these, by four weights, beside the truth

    void add(const CompareFigures& other);
};

// Lines of text: bias and root mean square in percent of the mean of what is shown; where that is all light,
// by part, with their shares of it.
[[nodiscard]] std::string table_of(const CompareFigures& figures, Show shown);

}  // namespace drtv::picture
