#include "bakerd/worker/array_file.h"

#include "bakerd/worker/protocol.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

namespace drtv::worker {
namespace {

using Json = nlohmann::json;

// The first line. Behind it stand the batches, one line a sector.
struct Head {
    BuildId build;
    std::vector<std::size_t> ends;  // of the batches, in bytes behind the head
};

constexpr int file_version = 1;

std::optional<Head> head_of(std::string_view line) {
    try {
        const Json json = Json::parse(line);
        if (json.at("version").get<int>() != file_version)
            return std::nullopt;
        return Head{{json.at("baker_version").get<std::uint32_t>(),
                     json.at("commit").get<std::string>(),
                     json.at("isa_class").get<std::string>()},
                    json.at("ends").get<std::vector<std::size_t>>()};
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

std::optional<std::vector<BakeRequest>> batch_of(std::string_view lines) {
    std::vector<BakeRequest> sectors;
    while (!lines.empty()) {
        const std::size_t end = lines.find('\n');
        const auto request = decode_request(lines.substr(0, end));
        const auto* bake = request ? std::get_if<BakeRequest>(&request->what) : nullptr;
        if (bake == nullptr || end == lines.npos)
            return std::nullopt;
        sectors.push_back(*bake);
        lines.remove_prefix(end + 1);
    }
    return sectors;
}

// Of a batch, behind the head.
std::size_t begin_of(const Head& head, std::size_t task) {
    return task == 0 ? 0 : head.ends[task - 1];
}

}  // namespace

std::string encode(const ArrayFile& array) {
    std::string body;
    Json ends = Json::array();
    for (const std::vector<BakeRequest>& batch : array.batches) {
        for (const BakeRequest& sector : batch)
            body += encode(Request{0, sector}) + "\n";
        ends.push_back(body.size());
    }
    const Json head = {{"version", file_version},
                       {"baker_version", array.build.baker_version},
                       {"commit", array.build.commit},
                       {"isa_class", array.build.isa_class},
                       {"ends", std::move(ends)}};
    return head.dump() + "\n" + body;
}

tl::expected<ArrayFile, std::string> decode_array(std::string_view text) {
    const tl::unexpected<std::string> damaged(std::string("it is no list of an array's sectors"));
    const std::size_t line = text.find('\n');
    const auto head = head_of(text.substr(0, line));
    if (!head || line == text.npos)
        return damaged;
    const std::string_view body = text.substr(line + 1);
    ArrayFile array;
    array.build = head->build;
    for (std::size_t task = 0; task < head->ends.size(); ++task) {
        const std::size_t begin = begin_of(*head, task), end = head->ends[task];
        if (end < begin || end > body.size())
            return damaged;
        auto batch = batch_of(body.substr(begin, end - begin));
        if (!batch)
            return damaged;
        array.batches.push_back(std::move(*batch));
    }
    return array;
}

tl::expected<Batch, std::string> read_batch(const std::string& path, std::size_t task) {
    const auto fail = [&](const std::string& why) {
        return tl::unexpected(fmt::format("cannot read the array {}: {}", path, why));
    };
    std::ifstream file(path, std::ios::binary);
    std::string line;
    if (!std::getline(file, line))
        return fail(file.is_open() ? "it is empty" : std::strerror(errno));
    const auto head = head_of(line);
    if (!head)
        return fail("it is no list of an array's sectors");
    if (task >= head->ends.size())
        return fail(fmt::format("it has no task {}, but {}", task, head->ends.size()));
    const std::size_t begin = begin_of(*head, task), end = head->ends[task];
    if (file.eof())
        return fail(fmt::format("task {} is cut off", task));
    const auto body = static_cast<std::size_t>(file.tellg());
    file.seekg(0, std::ios::end);
    const auto size = static_cast<std::size_t>(file.tellg()) - body;
    if (end < begin || end > size)
        return fail(fmt::format("task {} is cut off", task));
    std::string lines(end - begin, '\0');
    file.seekg(static_cast<std::streamoff>(body + begin));
    if (!file.read(lines.data(), static_cast<std::streamsize>(lines.size())))
        return fail(fmt::format("task {} cannot be read", task));
    auto sectors = batch_of(lines);
    if (!sectors)
        return fail(fmt::format("task {} is damaged", task));
    return Batch{head->build, std::move(*sectors)};
}

}  // namespace drtv::worker
