#include "bakerd/picture/show.h"

#include <algorithm>

namespace drtv::picture {

const std::vector<ShowName>& show_names() {
    static const std::vector<ShowName> names = {{Show::all, "all"},
                                                {Show::ambient, "ambient"},
                                                {Show::sky_direct, "sky_direct"},
                                                {Show::sky_bounce, "sky_bounce"},
                                                {Show::sun_bounce, "sun_bounce"},
                                                {Show::static_light, "static"},
                                                {Show::local, "local"},
                                                {Show::fallback, "fallback"},
                                                {Show::tile, "tile"},
                                                {Show::cells, "cells"},
                                                {Show::leaks, "leaks"},
                                                {Show::probes, "probes"},
                                                {Show::weights, "weights"},
                                                {Show::age, "age"},
                                                {Show::clipped, "clipped"}};
    return names;
}

std::string_view name_of(Show show) {
    return std::ranges::find(show_names(), show, &ShowName::show)->name;
}

Show show_of(std::string_view name) {
    return std::ranges::find(show_names(), name, &ShowName::name)->show;
}

}  // namespace drtv::picture
