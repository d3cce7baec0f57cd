#include "bakerd/worker/bake_threads.h"

#include <gtest/gtest.h>

#include <future>
#include <vector>

namespace drtv::worker {
namespace {

TEST(BakeThreads, WhatWaitsIsBegunByRank) {
    BakeThreads threads(1);
    std::promise<void> begun;
    std::promise<void> open;
    threads.enqueue([&, gate = open.get_future().share()] {
        begun.set_value();
        gate.wait();
    });
    begun.get_future().wait();
    std::vector<int> order;
    for (const int rank : {2, 1, 2, 0, 1})
        threads.enqueue([&order, rank] { order.push_back(rank); }, rank);
    open.set_value();
    threads.wait();
    EXPECT_EQ(order, (std::vector<int>{0, 1, 1, 2, 2}));
}

}  // namespace
}  // namespace drtv::worker
