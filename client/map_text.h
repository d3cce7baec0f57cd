// What a map was understood to hold, in words and as JSON.
#pragma once

#include "drtv/v1/map.pb.h"

#include <string>

namespace drtv::client {

[[nodiscard]] std::string map_json_line(const v1::Map& map);  // one object
[[nodiscard]] std::string map_text(const v1::Map& map);       // some lines, without the last one's end

}  // namespace drtv::client
