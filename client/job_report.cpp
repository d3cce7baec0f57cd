#include "client/job_report.h"

#include <algorithm>
#include <cctype>
#include <functional>

namespace drtv::client {
namespace {

void add_to(v1::StageSeconds& sum, const v1::StageSeconds& more) {
    sum.set_scene(sum.scene() + more.scene());
    sum.set_placement(sum.placement() + more.placement());
    sum.set_transfer(sum.transfer() + more.transfer());
    sum.set_local_transfer(sum.local_transfer() + more.local_transfer());
    sum.set_files(sum.files() + more.files());
}

void add_to(v1::Placement& sum, const v1::Placement& more) {
    sum.set_candidates(sum.candidates() + more.candidates());
    sum.set_too_near(sum.too_near() + more.too_near());
    sum.set_moved_out(sum.moved_out() + more.moved_out());
    sum.set_dropped_in_solid(sum.dropped_in_solid() + more.dropped_in_solid());
    sum.set_removed_by_volume(sum.removed_by_volume() + more.removed_by_volume());
    sum.set_thinned(sum.thinned() + more.thinned());
}

// The smallest value at or below which so much of the weight lies.
double weighted_quantile(std::vector<std::pair<double, std::int64_t>> values, double share) {
    std::ranges::sort(values);
    double total = 0;
    for (const auto& [value, weight] : values)
        total += static_cast<double>(weight);
    double sum = 0;
    for (const auto& [value, weight] : values) {
        sum += static_cast<double>(weight);
        if (sum >= share * total)
            return value;
    }
    return 0;
}

bool ends_name(std::string_view sentence, std::size_t quote) {
    return quote + 1 >= sentence.size() || std::isalnum(static_cast<unsigned char>(sentence[quote + 1])) == 0;
}

}  // namespace

void JobReport::add(const v1::Sector& sector) {
    if (sector.state() == v1::Sector::FAILED)
        failures.push_back({sector.coordinate(), sector.error()});
    const bool is_done = sector.state() == v1::Sector::DONE;
    if (!sector.cause().empty() && (!is_done || sector.has_stages()))
        ++causes_[sector.cause()];
    if (!is_done)
        return;
    if (sector.has_stages()) {
        add_to(stages, sector.stages());
        v1::Sector& baked = baked_.emplace_back();
        *baked.mutable_coordinate() = sector.coordinate();
        *baked.mutable_stages() = sector.stages();
        baked.set_probes(sector.probes());
        baked.set_rays(sector.rays());
    }
    add_numbers(sector);
    for (const std::string& sentence : sector.warnings()) {
        std::vector<Warning>& of_thing = warnings[named_thing(sentence)];
        const auto [known, is_new] = known_.try_emplace(sentence, of_thing.size());
        if (is_new)
            of_thing.push_back({sentence, 0});
        ++of_thing[known->second].sectors;
    }
}

void JobReport::add_numbers(const v1::Sector& sector) {
    if (!sector.has_placement()) {
        unknown += sector.probes() > 0 ? 1 : 0;
        return;
    }
    add_to(placement, sector.placement());
    const v1::ReachedError& reached = sector.reached_error();
    error_medians_.emplace_back(reached.median(), sector.probes());
    error_tails_.emplace_back(reached.p95(), sector.probes());
    error_max_ = std::max(error_max_, reached.max());
    budget_ended_ += reached.budget_ended();
}

std::vector<std::pair<std::string, std::int64_t>> JobReport::causes() const {
    std::vector<std::pair<std::string, std::int64_t>> causes(causes_.begin(), causes_.end());
    std::ranges::stable_sort(causes, std::greater(), [](const auto& cause) { return cause.second; });
    return causes;
}

std::vector<v1::Sector> JobReport::slowest(std::size_t count) const {
    std::vector<v1::Sector> sectors = baked_;
    std::ranges::stable_sort(
        sectors, std::greater(), [](const v1::Sector& sector) { return total_of(sector.stages()); });
    sectors.resize(std::min(count, sectors.size()));
    return sectors;
}

v1::ReachedError JobReport::error() const {
    v1::ReachedError error;
    error.set_median(weighted_quantile(error_medians_, 0.5));
    error.set_p95(weighted_quantile(error_tails_, 0.95));
    error.set_max(error_max_);
    error.set_budget_ended(budget_ended_);
    return error;
}

std::int64_t JobReport::warning_count() const {
    auto count = static_cast<std::int64_t>(map_warnings.size());
    for (const auto& [thing, sentences] : warnings)
        count += static_cast<std::int64_t>(sentences.size());
    return count;
}

double total_of(const v1::StageSeconds& stages) {
    return stages.scene() + stages.placement() + stages.transfer() + stages.local_transfer() + stages.files();
}

std::string named_thing(std::string_view sentence) {
    if (sentence.find("without a name") < sentence.find('\''))
        return "";
    const std::size_t begin = sentence.find('\'');
    if (begin == std::string_view::npos)
        return "";
    for (std::size_t end = sentence.find('\'', begin + 1); end != std::string_view::npos;
         end = sentence.find('\'', end + 1)) {
        if (ends_name(sentence, end))
            return std::string(sentence.substr(begin + 1, end - begin - 1));
    }
    return "";
}

}  // namespace drtv::client
