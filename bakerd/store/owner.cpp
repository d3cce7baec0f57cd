#include "bakerd/store/owner.h"

#include "bakerd/store/durable_file.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

namespace drtv::store {

namespace {

// Who wrote the file before it told the place is known by its id.
std::string place_of_owner(const std::string& path, const std::string& owner) {
    const auto bytes = read_all(path);
    const auto lines = bytes ? lines_of(text_of_bytes(*bytes)) : std::vector<std::string_view>();
    return lines.size() < 2 || lines[1].empty() ? owner : as_utf8(lines[1]);
}

}  // namespace

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

Result<void> claim_folder(const std::string& folder,
                          const std::string& owner,
                          const std::string& place,
                          bool is_known) {
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
                        place_of_owner(path, *known),
                        path));
    if (is_known)
        return fail(ErrorCode::failed_precondition,
                    fmt::format("the store {} has lost its file \"owner\", and probably all else: is it "
                                "mounted? If it is to begin anew, write {} into {}",
                                folder,
                                owner,
                                path));
    return write_mark(path, owner + "\n" + place);
}

}  // namespace drtv::store
