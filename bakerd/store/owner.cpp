#include "bakerd/store/owner.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>

namespace drtv::store {

Result<void> claim_folder(const std::string& folder, const std::string& owner) {
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code)
        return fail(ErrorCode::internal, fmt::format("cannot make the store {}: {}", folder, code.message()));
    const std::string path = folder + "/owner";
    std::string known;
    std::getline(std::ifstream(path), known);
    if (known == owner)
        return {};
    if (!known.empty())
        return fail(
            ErrorCode::failed_precondition,
            fmt::format("the store {} belongs to another daemon's data folder ({}): give each daemon a "
                        "store of its own, or remove {} if that daemon is no more",
                        folder,
                        known,
                        path));
    std::ofstream file(path);
    file << owner << "\n";
    file.close();
    if (!file)
        return fail(ErrorCode::internal, fmt::format("cannot write to the store {}", folder));
    return {};
}

}  // namespace drtv::store
