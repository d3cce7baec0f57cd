// The tool's commands. main.cpp makes their requests from the command line; each gives the exit code
// where it did not fail.
#pragma once

#include "cli/failure.h"
#include "kit/light_request.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace drtv::tool {

struct ValidateRequest {
    std::vector<std::string> paths;
    std::vector<std::string> ignored;  // codes
    std::size_t max_findings = 100;
    bool json = false;
    bool quick = false;
    bool neighbours = false;
    bool warnings_as_errors = false;
    bool whole = false;  // a folder needs a manifest that says that it is whole
};
cli::Result<cli::ExitCode> run_validate(const ValidateRequest& request);

cli::Result<cli::ExitCode> run_info(const std::string& file);

// As JSON.
cli::Result<cli::ExitCode> run_dump(const std::string& file);

struct PreviewRequest {
    std::string path;
    std::string out;
    double metres_per_pixel = 0;  // 0: as fits the region
    std::string quantity;         // one of dot_quantity_names()
    kit::LightRequest light;      // its time and gradients
    std::optional<std::string> under;
};
cli::Result<cli::ExitCode> run_preview(const PreviewRequest& request);

struct StripRequest {
    std::string in;
    std::string out;
    std::vector<std::string> keep;  // of optional_section_names()
    bool compress = false;
};
cli::Result<cli::ExitCode> run_strip(const StripRequest& request);
[[nodiscard]] std::vector<std::string> optional_section_names();

struct DiffRequest {
    std::string first;
    std::string second;
    std::optional<std::string> png;
    double metres_per_pixel = 0;  // as above
    bool json = false;
};
cli::Result<cli::ExitCode> run_diff(const DiffRequest& request);

struct TilesRequest {
    std::string path;
    std::string out;
};
cli::Result<cli::ExitCode> run_tiles(const TilesRequest& request);

cli::Result<cli::ExitCode> run_issues();

}  // namespace drtv::tool
