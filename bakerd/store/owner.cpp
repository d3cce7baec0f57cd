#include "bakerd/store/owner.h"

#include "bakerd/store/durable_file.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace drtv::store {

Result<std::string> read_mark(const std::string& path) {
    std::error_code code;
    if (!std::filesystem::exists(path, code) && !code)
        return "";
    const auto bytes = read_all(path);
    if (!bytes)
        return tl::unexpected(bytes.error());
    const std::string text(bytes->begin(), bytes->end());
    return text.substr(0, text.find('\n'));
}

Result<void> write_mark(const std::string& path, const std::string& text) {
    const std::string line = text + "\n";
    return write_durably(path.substr(0, path.rfind('/')), path, bytes_of_text(line));
}

Result<void> claim_folder(const std::string& folder, const std::string& owner, bool is_known) {
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code)
        return fail(ErrorCode::internal, fmt::format("cannot make the store {}: {}", folder, code.message()));
    const std::string path = folder + "/owner";
    const auto known = read_mark(path);
    if (!known)
        return tl::unexpected(known.error());
    if (*known == owner)
        return {};
    if (!known->empty())
        return fail(
            ErrorCode::failed_precondition,
            fmt::format("the store {} belongs to another daemon's data folder ({}): give each daemon a "
                        "store of its own, or remove {} if that daemon is no more",
                        folder,
                        *known,
                        path));
    if (is_known)
        return fail(ErrorCode::failed_precondition,
                    fmt::format("the store {} has lost its file \"owner\", and probably all else: is it "
                                "mounted? If it is to begin anew, write {} into {}",
                                folder,
                                owner,
                                path));
    return write_mark(path, owner);
}

}  // namespace drtv::store
