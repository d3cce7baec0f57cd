// Speaks the worker's protocol. `argv[1]` is how it behaves as a whole, a sector's `i` how it treats the
// request:
//
//     fake_worker normal | gate FILE | die_at_start | deaf | garbage | close_output | reverse N
#include "bakerd/worker/protocol.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include "tests/executor/fake_worker.h"

namespace {

using namespace drtv::worker;
namespace fake = drtv::test::fake;

std::filesystem::path gate;

void say(const Answer& answer) {
    std::printf("%s\n", encode(answer).c_str());
    std::fflush(stdout);
}

SectorResult baked(const BakeRequest& request) {
    SectorResult result;
    result.blobs.file = request.manifest;
    result.file_bytes = request.settings.bake.rays;
    result.probes = request.sector.j;
    result.rays = 7;
    return result;
}

void answer(std::uint64_t id, const BakeRequest& request) {
    static std::map<std::int32_t, int> tries;
    switch (request.sector.i) {
        case fake::deadly:
            std::raise(SIGKILL);
            break;
        case fake::quits:
            std::_Exit(3);
        case fake::silent:
            return;
        case fake::gated:
            std::thread([id, request] {
                while (!std::filesystem::exists(gate))
                    std::this_thread::sleep_for(std::chrono::milliseconds(2));
                say({id, baked(request)});
            }).detach();
            return;
        case fake::fails_once:
            if (tries[request.sector.j]++ == 0)
                return say({id, RequestFailure{"not now", true}});
            break;
        case fake::always_later:
            return say({id, RequestFailure{"the disk is full", true}});
        case fake::hopeless:
            return say({id, RequestFailure{"the sector is bad", false}});
        case fake::unknown_id:
            say({id + 1000000, baked(request)});
            break;
        case fake::twice:
            say({id, baked(request)});
            break;
        default:
            break;
    }
    say({id, baked(request)});
}

void answer(std::uint64_t id, const AssessRequest&) {
    say({id, RequestFailure{"the fake worker has no opinion", false}});
}

void answer(std::uint64_t id, const InspectRequest& request) {
    if (request.manifest.bytes[0] == fake::silent_map)
        return;
    if (request.manifest.bytes[0] == fake::deadly_map)
        std::raise(SIGKILL);
    MapSummary inspected;
    inspected.content = request.manifest;
    inspected.survey.static_objects = 5;
    say({id, inspected});
}

}  // namespace

int main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "normal";
    if (mode == "die_at_start")
        return 4;
    if (mode == "deaf")
        ::sleep(60);
    if (mode == "close_output")
        ::close(STDOUT_FILENO);
    if (mode == "gate" && argc > 2)
        gate = argv[2];
    std::size_t batch = mode == "reverse" && argc > 2 ? std::stoul(argv[2]) : 1;
    std::vector<Request> held;
    std::string line;
    while (std::getline(std::cin, line)) {
        const auto request = decode_request(line);
        if (!request)
            return 1;
        if (mode == "garbage") {
            std::puts("this is no answer");
            std::fflush(stdout);
            continue;
        }
        held.push_back(*request);
        if (held.size() < batch)
            continue;
        for (auto entry = held.rbegin(); entry != held.rend(); ++entry)
            std::visit([&](const auto& what) { answer(entry->id, what); }, entry->what);
        held.clear();
    }
    std::_Exit(0);
}
