#include "bakerd/reuse/describe.h"

#include "bakerd/reuse/crossed_blocks.h"

#include <fmt/format.h>

#include <cmath>

namespace drtv::reuse {
namespace {

const char* words_for(ItemKind kind) {
    switch (kind) {
        case ItemKind::fixed:
        case ItemKind::vegetation:
            return "an object";
        case ItemKind::lamp:
            return "a lamp";
        case ItemKind::sun:
            return "a sun";
        case ItemKind::manual_probe:
            return "a probe";
        case ItemKind::no_probes:
            return "a no_probes volume";
        case ItemKind::interior:
            return "an interior";
        case ItemKind::spacing:
            return "a bake_spacing volume";
    }
    return "something";
}

const char* words_for(ChangeKind kind) {
    switch (kind) {
        case ChangeKind::added:
            return "was added";
        case ChangeKind::removed:
            return "was deleted";
        case ChangeKind::moved:
            return "moved";
        case ChangeKind::changed:
            return "changed";
    }
    return "changed";
}

std::string where_rays_cross(const Item& item, float bound) {
    const glm::vec3 middle = (item.bounds.low + item.bounds.high) * 0.5f;
    const auto sector = [](float metres) {
        return static_cast<std::int32_t>(std::floor(metres / static_cast<float>(map::sector_size_m)));
    };
    const std::string where = fmt::format("rays cross sector ({}, {})", sector(middle.x), sector(middle.y));
    return bound >= unbounded ? where : fmt::format("{}, bound {:.2g} %", where, bound * 100);
}

std::string words_for(const Assessment& assessment, const Item& item) {
    switch (assessment.cause) {
        case Cause::rays:
            return where_rays_cross(item, assessment.change_bound);
        case Cause::placement:
            return "it may move probes";
        case Cause::light:
            return "it shines here";
        case Cause::interior:
            return "its probe stands here";
    }
    return "";
}

}  // namespace

std::string describe(const Change& change) {
    const Item& item = change.item();
    const std::string name =
        item.name.empty() ? std::string(words_for(item.kind)) + " without a name" : item.name;
    return fmt::format("{} {}", name, words_for(change.kind));
}

std::string describe(const Assessment& assessment, std::span<const Change> changes) {
    const std::string cause = describe_cause(assessment, changes);
    if (!assessment.change)
        return cause;
    return fmt::format("{}: {}", cause, words_for(assessment, changes[*assessment.change].item()));
}

std::string describe_cause(const Assessment& assessment, std::span<const Change> changes) {
    if (assessment.change)
        return describe(changes[*assessment.change]);
    if (assessment.verdict == Verdict::rebake)
        return "what is kept of it may be off by more than is asked";
    return "";
}

}  // namespace drtv::reuse
