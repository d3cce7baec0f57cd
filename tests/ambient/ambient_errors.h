// Errors of many ways to light, place by place.
#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace drtv::test {

// Errors of one way, a number per place: the root mean square over normals, moments and channels, over the
// mean of the truth there.
struct Errors {
    std::string name;
    std::vector<double> rms;
    double bias = 0;  // of all places together, over the mean of the truth

    [[nodiscard]] double median() const { return quantile(0.5); }
    [[nodiscard]] double quantile(double share) const;
};

// REQUIRES: there is one of that name.
[[nodiscard]] const Errors& find(const std::vector<Errors>& of, const std::string& name);

// Squared differences of one place.
struct Sum {
    double squares = 0;
    double difference = 0;
    double truth = 0;
    std::size_t count = 0;

    void add(const glm::dvec3& found, const glm::dvec3& truth_there) {
        for (glm::length_t c = 0; c < 3; ++c) {
            squares += std::pow(found[c] - truth_there[c], 2);
            difference += found[c] - truth_there[c];
            truth += truth_there[c];
            ++count;
        }
    }
};

// By name, in the order in which names came first.
class Sums {
  public:
    Sum& operator[](const std::string& name) {
        for (auto& [known, sum] : sums_) {
            if (known == name)
                return sum;
        }
        return sums_.emplace_back(name, Sum{}).second;
    }
    [[nodiscard]] const std::vector<std::pair<std::string, Sum>>& all() const { return sums_; }

  private:
    std::vector<std::pair<std::string, Sum>> sums_;
};

struct Place {
    Sums sums;
    double mean = 0;  // of the truth
};

// Places whose truth is darker than 1/1000 are left out.
[[nodiscard]] std::vector<Errors> errors_of(const std::vector<Place>& places);

void print(const char* title, const std::vector<Errors>& errors);

}  // namespace drtv::test
