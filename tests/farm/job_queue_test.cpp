// Who is next: by priority, by what owners have had, by rank.
#include "bakerd/farm/job_queue.h"

#include <gtest/gtest.h>

#include <map>

namespace drtv::farm {
namespace {

using executor::Priority;

// The task is taken, at so many seconds.
JobQueue::Wants at(double seconds) {
    return [seconds](std::int64_t, std::uint64_t) { return JobQueue::Wanted{true, seconds}; };
}

QueuePlace of(const std::string& owner, Priority priority = Priority::interactive) {
    return {owner, priority, 0, false};
}

// Tasks of a job have its number times 1,000.
void fill(JobQueue& queue, std::int64_t job, const QueuePlace& place, std::uint64_t tasks) {
    queue.put(job, place);
    for (std::uint64_t n = 0; n < tasks; ++n)
        queue.push(job, 1000 * static_cast<std::uint64_t>(job) + n);
}

std::vector<std::uint64_t> jobs_of_next(JobQueue& queue, std::size_t count, double seconds = 1) {
    std::vector<std::uint64_t> jobs;
    for (std::size_t n = 0; n < count; ++n)
        jobs.push_back(queue.next(Priority::interactive, at(seconds)).value_or(0) / 1000);
    return jobs;
}

TEST(JobQueue, AnOwnersJobsGoOneAfterTheOther) {
    JobQueue queue;
    fill(queue, 1, of("ann"), 2);
    fill(queue, 2, of("ann"), 2);
    EXPECT_EQ(jobs_of_next(queue, 5), (std::vector<std::uint64_t>{1, 1, 2, 2, 0}));
    EXPECT_FALSE(queue.next(Priority::nightly, at(1)));
}

TEST(JobQueue, OwnersTakeTurnsByWhatTheyHaveHad) {
    JobQueue queue;
    fill(queue, 1, of("ann"), 1000);
    EXPECT_EQ(jobs_of_next(queue, 100), std::vector<std::uint64_t>(100, 1)) << "alone";
    fill(queue, 2, of("bob"), 1000);
    // Bob did not wait meanwhile, and has no claim to it.
    std::map<std::uint64_t, int> had;
    for (const std::uint64_t job : jobs_of_next(queue, 100))
        ++had[job];
    EXPECT_EQ(had[1], 50);
    EXPECT_EQ(had[2], 50);
    // Ann's sectors turn out to take three times as long.
    for (int n = 0; n < 300; ++n) {
        if (jobs_of_next(queue, 1).front() == 1) {
            ++had[3];
            queue.charge(1, 2);
        }
    }
    EXPECT_NEAR(had[3], 75, 2);
}

// Each change of maps would cost a load.
TEST(JobQueue, ATurnIsLongerThanASector) {
    JobQueue queue;
    queue.set_turn(10);
    fill(queue, 1, of("ann"), 1000);
    fill(queue, 2, of("bob"), 1000);
    fill(queue, 3, of("cat"), 1000);
    const std::vector<std::uint64_t> order = jobs_of_next(queue, 300);
    std::map<std::uint64_t, int> had;
    int changes = 0;
    for (std::size_t n = 0; n < order.size(); ++n) {
        ++had[order[n]];
        changes += n > 0 && order[n] != order[n - 1] ? 1 : 0;
    }
    for (const auto& [job, sectors] : had)
        EXPECT_NEAR(sectors, 100, 12) << job;
    EXPECT_LE(changes, 40);
}

TEST(JobQueue, WhoComesBackBeginsWhereTheOthersAre) {
    JobQueue queue;
    fill(queue, 1, of("ann"), 10);
    fill(queue, 2, of("bob"), 1000);
    static_cast<void>(jobs_of_next(queue, 500));  // ann's are done
    fill(queue, 3, of("ann"), 1000);
    std::map<std::uint64_t, int> had;
    for (const std::uint64_t job : jobs_of_next(queue, 100))
        ++had[job];
    EXPECT_NEAR(had[3], 50, 1);
}

TEST(JobQueue, RaisedJobsGoFirstAndHeldOnesWait) {
    JobQueue queue;
    for (const std::int64_t job : {1, 2, 3})
        fill(queue, job, of("ann"), 2);
    EXPECT_EQ(jobs_of_next(queue, 1), (std::vector<std::uint64_t>{1}));
    queue.put(2, {"ann", Priority::interactive, 5, false});
    queue.put(3, {"ann", Priority::interactive, 6, false});
    EXPECT_EQ(jobs_of_next(queue, 1), (std::vector<std::uint64_t>{3})) << "raised last";
    queue.put(3, {"ann", Priority::interactive, 6, true});
    queue.push(3, 3007);
    EXPECT_EQ(jobs_of_next(queue, 4), (std::vector<std::uint64_t>{2, 2, 1, 0}));
    queue.put(3, {"ann", Priority::interactive, 6, false});
    EXPECT_EQ(queue.next(Priority::interactive, at(1)), 3001u) << "in the order of baking";
    EXPECT_EQ(queue.next(Priority::interactive, at(1)), 3007u);
    queue.put(3, {"ann", Priority::interactive, 6, true});
    queue.remove(3);
    EXPECT_EQ(jobs_of_next(queue, 1), (std::vector<std::uint64_t>{0}));
}

TEST(JobQueue, WhatIsDeclinedCostsNothing) {
    JobQueue queue;
    fill(queue, 1, of("ann"), 10);
    fill(queue, 2, of("bob"), 10);
    const auto even = [](std::int64_t, std::uint64_t task) { return JobQueue::Wanted{task % 2 == 0, 1}; };
    int taken = 0;
    while (queue.next(Priority::interactive, even))
        ++taken;
    EXPECT_EQ(taken, 10);
}

TEST(JobQueue, TellsWhoIsBefore) {
    JobQueue queue;
    fill(queue, 1, of("ann"), 1);
    fill(queue, 2, of("bob"), 1);
    fill(queue, 3, of("ann"), 1);
    fill(queue, 4, of("ann", Priority::nightly), 1);
    fill(queue, 5, of("ann", Priority::nightly), 1);
    EXPECT_EQ(queue.line_before(3).before, (std::vector<std::int64_t>{1}));
    EXPECT_EQ(queue.line_before(3).owners, 2u);
    EXPECT_TRUE(queue.line_before(2).before.empty());
    EXPECT_EQ(queue.line_before(5).before, (std::vector<std::int64_t>{1, 3, 2, 4}));
    EXPECT_EQ(queue.line_before(5).owners, 1u);
    static_cast<void>(jobs_of_next(queue, 3));
    EXPECT_EQ(queue.line_before(5).before, (std::vector<std::int64_t>{4}))
        << "the others have nothing left to begin";
}

}  // namespace
}  // namespace drtv::farm
