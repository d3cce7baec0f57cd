// Jobs in memory: who waits, and what a job that is opened again gets.
#include "bakerd/farm/job_book.h"

#include <gtest/gtest.h>

#include <array>

namespace drtv::farm {
namespace {

constexpr std::int64_t job_id = 5;
const WantedSector meadow{{3, 4}, std::nullopt};

JobRow running_job(std::int64_t id = job_id) {
    JobRow job;
    job.id = id;
    job.request_id = "request " + std::to_string(id);
    job.sectors_total = 1;
    return job;
}

JobRow ended(JobRow job, JobState state) {
    job.state = state;
    job.ended_ms = 1;
    return job;
}

executor::Reply<worker::SectorResult> failure() {
    return tl::unexpected(worker::RequestFailure{"it cannot be baked", false});
}

TEST(JobBook, JobWaitsUntilASectorOfItIsTakenUp) {
    JobBook book;
    book.add(running_job(1), {&meadow, 1}, {}, 12.5);
    book.add(running_job(2), {&meadow, 1});
    EXPECT_TRUE(book.view(1)->waiting);
    EXPECT_EQ(book.view(1)->seconds_left, 12.5);
    ASSERT_TRUE(book.next(executor::Priority::interactive));
    // Both wait for the same bake.
    EXPECT_FALSE(book.view(1)->waiting);
    EXPECT_FALSE(book.view(2)->waiting);
    book.update(ended(running_job(1), JobState::cancelled));
    EXPECT_FALSE(book.view(1)->waiting);
    EXPECT_EQ(book.view(1)->seconds_left, 0);
}

// The recorder tells the book of the end first, and only then that the task has left: a retry in between must
// not join the task that is about to be forgotten.
TEST(JobBook, ReopenedJobGetsATaskOfItsOwn) {
    JobBook book;
    book.add(running_job(), {&meadow, 1});
    const executor::SectorTask task = book.next(executor::Priority::interactive).value();
    ASSERT_TRUE(book.finish({task.id, 3, failure()}));
    book.update(ended(running_job(), JobState::failed));
    book.reopen(running_job(), {&meadow, 1});
    EXPECT_TRUE(book.leave(task.id, std::array{job_id}).empty());
    const auto again = book.next(executor::Priority::interactive);
    ASSERT_TRUE(again);
    EXPECT_NE(again->id, task.id);
    EXPECT_TRUE(book.is_running(job_id, meadow.sector));
    // The later task is found by others, although the one before had its key.
    book.add(running_job(6), {&meadow, 1});
    EXPECT_FALSE(book.next(executor::Priority::interactive));
    const auto finished = book.finish({again->id, 3, failure()});
    ASSERT_TRUE(finished);
    EXPECT_EQ(finished->jobs.size(), 2u);
}

JobRow nightly_job(std::int64_t id) {
    JobRow job = running_job(id);
    job.priority = executor::Priority::nightly;
    return job;
}

TEST(JobBook, SectorsAreAskedForByPriority) {
    JobBook book;
    const WantedSector river{{5, 4}, std::nullopt, 7.5};
    book.add(nightly_job(1), {&meadow, 1});
    book.add(running_job(2), {&river, 1});
    const auto first = book.next(executor::Priority::interactive);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->request.sector, river.sector);
    EXPECT_EQ(std::tuple(first->priority, first->seconds), std::tuple(executor::Priority::interactive, 7.5));
    EXPECT_FALSE(book.next(executor::Priority::interactive));
    const auto second = book.next(executor::Priority::nightly);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->request.sector, meadow.sector);
    EXPECT_EQ(second->priority, executor::Priority::nightly);
}

TEST(JobBook, ANightlySectorThatSomebodyWaitsForIsBakedOnceAndEarly) {
    JobBook book;
    book.add(nightly_job(1), {&meadow, 1});
    book.add(running_job(2), {&meadow, 1});
    ASSERT_TRUE(book.next(executor::Priority::interactive));
    EXPECT_FALSE(book.next(executor::Priority::nightly));
}

TEST(JobBook, AGiantJobHoldsUpNobodyButItsOwner) {
    JobBook book;
    std::vector<WantedSector> giant;
    for (int i = 0; i < 10'000; ++i)
        giant.push_back({{i, 0}, std::nullopt});
    JobRow mistake = running_job(1);
    mistake.owner = "ann";
    mistake.sectors_total = 10'000;
    book.add(mistake, giant, {}, 5000);
    for (int n = 0; n < 4; ++n)
        ASSERT_TRUE(book.next(executor::Priority::interactive));
    JobRow small = running_job(2);
    small.owner = "bob";
    const WantedSector river{{5, 4}, std::nullopt};
    book.add(small, {&river, 1});
    EXPECT_EQ(book.view(2)->jobs_ahead, 0);
    JobRow later = running_job(3);
    later.owner = "ann";
    const WantedSector hill{{5, 5}, std::nullopt};
    book.add(later, {&hill, 1}, {}, 3);
    EXPECT_EQ(book.view(3)->jobs_ahead, 1);
    EXPECT_EQ(book.view(3)->seconds_to_start, 2 * 5000) << "two owners share the machine";
    std::set<std::int32_t> rows;
    for (int n = 0; n < 2; ++n)
        rows.insert(book.next(executor::Priority::interactive)->request.sector.j);
    EXPECT_TRUE(rows.contains(4)) << "bob's";

    // Ann mends it herself.
    mistake.held = true;
    book.move(mistake);
    EXPECT_EQ(book.view(3)->jobs_ahead, 0);
    EXPECT_EQ(book.next(executor::Priority::interactive)->request.sector, hill.sector);
    EXPECT_FALSE(book.next(executor::Priority::interactive));
    // A recorder that read the row before tells after.
    mistake.held = false;
    book.update(mistake);
    EXPECT_TRUE(book.view(1)->row.held);
    EXPECT_FALSE(book.next(executor::Priority::interactive));
    book.move(mistake);
    EXPECT_TRUE(book.next(executor::Priority::interactive));
    EXPECT_EQ(book.list(100, 10, "ann").size(), 2u);
    EXPECT_EQ(book.list(100, 10).size(), 3u);
}

TEST(JobBook, ASectorAtWorkIsGivenUpWhenNobodyWantsIt) {
    JobBook book;
    book.add(running_job(1), {&meadow, 1});
    const executor::SectorTask task = book.next(executor::Priority::interactive).value();
    EXPECT_FALSE(book.give_up(task.id));
    book.update(ended(running_job(1), JobState::cancelled));
    EXPECT_TRUE(book.give_up(task.id));
    EXPECT_TRUE(book.give_up(task.id)) << "it is forgotten";
    EXPECT_FALSE(book.finish({task.id, 0, failure()}));
    // The next job gets one of its own.
    book.add(running_job(2), {&meadow, 1});
    EXPECT_NE(book.next(executor::Priority::interactive)->id, task.id);
}

TEST(JobBook, ForgottenRequestIsNoAnswerAnyMore) {
    JobBook book;
    book.add(running_job(), {&meadow, 1});
    EXPECT_EQ(book.begin_request("request 5"), job_id);
    JobRow cancelled = ended(running_job(), JobState::cancelled);
    cancelled.request_id.clear();
    book.update(cancelled);
    EXPECT_FALSE(book.begin_request("request 5"));
    book.end_request("request 5");
}

}  // namespace
}  // namespace drtv::farm
