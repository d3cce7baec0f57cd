#include "bakerd/worker/answers.h"

#include "bakerd/store/durable_file.h"
#include "bakerd/store/text_bytes.h"
#include "bakerd/worker/build_id.h"
#include "bakerd/worker/protocol.h"

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace drtv::worker {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

// On threads that wait for the store most of the time.
template <class Work>
void for_each_number(std::size_t count, const Work& work) {
    constexpr std::size_t max_threads = 8;
    constexpr std::size_t least = 16;  // of a thread
    std::atomic<std::size_t> next = 0;
    const auto run = [&] {
        for (std::size_t n = next++; n < count; n = next++)
            work(n);
    };
    std::vector<std::jthread> threads;
    try {
        while (threads.size() + 1 < std::min(max_threads, count / least))
            threads.emplace_back(run);
    } catch (const std::system_error&) {
        // The machine has no more; it goes on with those that there are.
    }
    run();
}

}  // namespace

Digest answer_key(const BakeRequest& request) {
    BakeRequest alone = request;
    alone.earlier.reset();
    return map::digest_of(store::bytes_of_text(
        fmt::format("{} {}", text_of(this_build()), encode(Request{0, std::move(alone)}))));
}

store::Result<Answers> Answers::open(const std::string& store_folder) {
    Answers answers(store_folder + "/answers");
    if (auto made = store::make_folder(answers.folder_ + "/tmp"); !made)
        return tl::unexpected(made.error());
    return answers;
}

std::string Answers::folder_of(const std::string& hex) const {
    return fmt::format("{}/{}", folder_, hex.substr(0, 2));
}

std::string Answers::path_of(const Digest& key) const {
    const std::string hex = to_hex(key);
    return fmt::format("{}/{}", folder_of(hex), hex);
}

// Two lines: the answer as a worker gives it, and what only a task has.
store::Result<void> Answers::write(const Digest& key, const TaskAnswer& answer) const {
    const std::string line = std::visit(
        [](const auto& what) {
            return encode(Answer{0, what});
        },
        answer.what);
    const Json task = {{"node", answer.node},
                       {"log", answer.log},
                       {"peak_memory_bytes", answer.peak_memory_bytes},
                       {"load_seconds", answer.load_seconds}};
    const std::string text = line + "\n" + task.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    return store::write_durably(folder_ + "/tmp", path_of(key), store::bytes_of_text(text));
}

std::vector<Digest> Answers::among(std::span<const Digest> keys) const {
    std::vector<Digest> found;
    for (auto key = keys.begin(); key != keys.end();) {
        const std::string folder = folder_of(to_hex(*key));
        std::error_code code;
        for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
            const auto name = map::digest_from_hex(entry->path().filename().string());
            if (name && std::ranges::binary_search(keys, *name))
                found.push_back(*name);
        }
        // The next folder begins where the first byte changes.
        const std::uint8_t first = key->bytes.front();
        key = std::find_if(
            key, keys.end(), [first](const Digest& next) { return next.bytes.front() != first; });
    }
    std::ranges::sort(found);
    return found;
}

std::optional<TaskAnswer> Answers::read(const Digest& key) const {
    const auto bytes = store::read_all(path_of(key));
    if (!bytes)
        return std::nullopt;
    const std::string_view text = store::text_of_bytes(*bytes);
    const std::size_t line = text.find('\n');
    const auto answer = decode_answer(text.substr(0, line));
    if (!answer || line == text.npos)
        return std::nullopt;
    TaskAnswer read;
    if (const auto* result = std::get_if<SectorResult>(&answer->what))
        read.what = *result;
    else if (const auto* failure = std::get_if<RequestFailure>(&answer->what))
        read.what = *failure;
    else
        return std::nullopt;
    try {
        const Json task = Json::parse(text.substr(line + 1));
        read.node = task.at("node").get<std::string>();
        read.log = task.at("log").get<std::string>();
        read.peak_memory_bytes = task.at("peak_memory_bytes").get<std::int64_t>();
        read.load_seconds = task.at("load_seconds").get<double>();
    } catch (const Json::exception&) {
        return std::nullopt;
    }
    return read;
}

std::vector<std::pair<Digest, TaskAnswer>> Answers::find(std::span<const Digest> keys) const {
    const std::vector<Digest> answered = among(keys);
    std::vector<std::optional<TaskAnswer>> answers(answered.size());
    for_each_number(answered.size(), [&](std::size_t n) { answers[n] = read(answered[n]); });
    std::vector<std::pair<Digest, TaskAnswer>> found;
    for (std::size_t n = 0; n < answered.size(); ++n) {
        if (answers[n])
            found.emplace_back(answered[n], std::move(*answers[n]));
    }
    return found;
}

void Answers::remove(std::span<const Digest> keys) const {
    for_each_number(keys.size(), [&](std::size_t n) { ::unlink(path_of(keys[n]).c_str()); });
}

}  // namespace drtv::worker
