// Speaks the worker's protocol. `argv[1]` is how it behaves as a whole, a sector's `i` how it treats the
// request:
//
//     fake_worker normal | gate FILE | die_at_start | garbage | close_output | reverse N
#include "bakerd/farm/worker_protocol.h"

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

#include "tests/farm/fake_worker.h"

namespace {

using namespace drtv::farm;
namespace fake = drtv::test::fake;

std::filesystem::path gate;

void say(const WorkerAnswer& answer) {
    std::printf("%s\n", encode(answer).c_str());
    std::fflush(stdout);
}

BakeAnswer baked(const BakeRequest& request) {
    return {request.manifest, request.settings.rays, request.sector.j, 7, {}};
}

void answer(const BakeRequest& request) {
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
            std::thread([request] {
                while (!std::filesystem::exists(gate))
                    std::this_thread::sleep_for(std::chrono::milliseconds(2));
                say({request.id, baked(request)});
            }).detach();
            return;
        case fake::fails_once:
            if (tries[request.sector.j]++ == 0)
                return say({request.id, FailureAnswer{"not now", true}});
            break;
        case fake::always_later:
            return say({request.id, FailureAnswer{"the disk is full", true}});
        case fake::hopeless:
            return say({request.id, FailureAnswer{"the sector is bad", false}});
        case fake::unknown_id:
            say({request.id + 1000000, baked(request)});
            break;
        case fake::twice:
            say({request.id, baked(request)});
            break;
        default:
            break;
    }
    say({request.id, baked(request)});
}

void answer(const AssessRequest& request) {
    say({request.id, FailureAnswer{"the fake worker has no opinion", false}});
}

void answer(const InspectRequest& request) {
    if (request.manifest.bytes[0] == fake::silent_map)
        return;
    if (request.manifest.bytes[0] == fake::deadly_map)
        std::raise(SIGKILL);
    InspectAnswer inspected;
    inspected.content = request.manifest;
    inspected.object_count = 5;
    say({request.id, inspected});
}

}  // namespace

int main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "normal";
    if (mode == "die_at_start")
        return 4;
    if (mode == "close_output")
        ::close(STDOUT_FILENO);
    if (mode == "gate" && argc > 2)
        gate = argv[2];
    std::size_t batch = mode == "reverse" && argc > 2 ? std::stoul(argv[2]) : 1;
    std::vector<WorkerRequest> held;
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
            std::visit([](const auto& r) { answer(r); }, *entry);
        held.clear();
    }
    std::_Exit(0);
}
