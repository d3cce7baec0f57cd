// What a job's sectors tell together: where its time went, what became of the probes' places, which error was
// reached, what looks wrong in the map.
#pragma once

#include "drtv/v1/sector.pb.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drtv::client {

class JobReport {
  public:
    struct Warning {
        std::string sentence;
        std::int64_t sectors = 0;  // that say it
    };
    struct Failure {
        v1::SectorCoordinate sector;
        std::string sentence;
    };

    // One of the job's sectors.
    void add(const v1::Sector& sector);

    // Sectors that were baked or wait for it, by the cause, the most frequent first.
    [[nodiscard]] std::vector<std::pair<std::string, std::int64_t>> causes() const;

    v1::StageSeconds stages;  // sums over baked sectors
    // Baked sectors, the slowest first; at most `count`.
    [[nodiscard]] std::vector<v1::Sector> slowest(std::size_t count) const;

    v1::Placement placement;   // sums over sectors
    std::int64_t unknown = 0;  // sectors of which an older server kept neither places nor errors
    // `median` and `p95`: half, and 95 %, of the probes stand in sectors whose median, or 95th percentile, is
    // no larger.
    [[nodiscard]] v1::ReachedError error() const;

    std::vector<std::string> map_warnings;  // of its import
    // By the thing of the map that they name first ("": none), each sentence once.
    std::map<std::string, std::vector<Warning>> warnings;
    [[nodiscard]] std::int64_t warning_count() const;
    std::vector<Failure> failures;

  private:
    void add_numbers(const v1::Sector& sector);

    std::map<std::string, std::int64_t> causes_;
    std::map<std::string, std::size_t> known_;  // sentences: their place among those of their thing
    std::vector<v1::Sector> baked_;             // what `slowest` gives, and no more
    // By sector, weighted by its probes.
    std::vector<std::pair<double, std::int64_t>> error_medians_;
    std::vector<std::pair<double, std::int64_t>> error_tails_;
    double error_max_ = 0;
    std::int64_t budget_ended_ = 0;
};

[[nodiscard]] double total_of(const v1::StageSeconds& stages);

// The thing that a sentence of bakerd names first: what stands in single quotes, as in "the light 'Sun' at".
// Empty where it names none; an apostrophe within a name ends it only before a blank or a mark.
[[nodiscard]] std::string named_thing(std::string_view sentence);

}  // namespace drtv::client
