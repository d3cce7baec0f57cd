// The frozen files of tests/data/golden: one a version of the format, one a kind of optional section, raw and
// compressed. A file that stands there is never written again; `write_golden` adds those that are new.
#pragma once

#include <drtv/write.h>

#include <string>
#include <vector>

namespace drtv::test {

struct GoldenFile {
    std::string name;
    Sector sector;
    Codec codec = Codec::raw;
    bool valid = true;
};

[[nodiscard]] std::vector<GoldenFile> golden_files();

}  // namespace drtv::test
