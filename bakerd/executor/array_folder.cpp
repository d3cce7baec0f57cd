#include "bakerd/executor/array_folder.h"

#include "bakerd/store/durable_file.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <filesystem>
#include <string_view>
#include <system_error>

namespace drtv::executor {

namespace fs = std::filesystem;

store::Result<ArrayFolder> ArrayFolder::open(const std::string& store_folder, const std::string& owner) {
    ArrayFolder folder(fmt::format("{}/arrays/{}", store_folder, owner));
    if (auto made = store::make_folder(folder.folder_ + "/tmp"); !made)
        return tl::unexpected(made.error());
    return folder;
}

std::string ArrayFolder::path_of(const std::string& key) const {
    return fmt::format("{}/{}", folder_, key);
}

store::Result<void> ArrayFolder::write(const std::string& key, const worker::ArrayFile& array) const {
    return store::write_durably(folder_ + "/tmp", path_of(key), store::bytes_of_text(worker::encode(array)));
}

void ArrayFolder::remove(const std::string& key) const {
    ::unlink(path_of(key).c_str());
}

store::Result<std::vector<std::pair<std::string, worker::ArrayFile>>> ArrayFolder::all() const {
    std::vector<std::pair<std::string, worker::ArrayFile>> arrays;
    std::error_code code;
    for (fs::directory_iterator entry(folder_, code), end; !code && entry != end; entry.increment(code)) {
        const std::string key = entry->path().filename().string();
        if (key == "tmp")
            continue;
        const auto bytes = store::read_all(entry->path().string());
        // A store that is ill now: what its tasks bake should not be baked again.
        if (!bytes)
            return tl::unexpected(bytes.error());
        auto array = worker::decode_array(store::text_of_bytes(*bytes));
        if (!array)
            spdlog::warn("array {}: {}", key, array.error());
        arrays.emplace_back(key, array ? std::move(*array) : worker::ArrayFile{});
    }
    return arrays;
}

}  // namespace drtv::executor
