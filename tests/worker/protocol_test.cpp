#include "bakerd/worker/protocol.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

namespace drtv::worker {
namespace {

const map::Digest some_digest = map::digest_of(test::bytes_of("some"));

BakeRequest bake_request() {
    return {some_digest,
            {-16384, 16384},
            {{.rays = 17, .bounces = 0, .reach_m = 0.1f, .min_distance_m = 64}, 0.01f},
            {}};
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what << " in " << text;
    return text.replace(at, what.size(), with);
}

TEST(WorkerProtocol, RequestsComeBackAsTheyWere) {
    const Request back = decode_request(encode(Request{UINT64_MAX, bake_request()})).value();
    EXPECT_EQ(back.id, UINT64_MAX);
    const auto bake = std::get<BakeRequest>(back.what);
    EXPECT_EQ(bake.manifest, some_digest);
    EXPECT_EQ(bake.sector, (map::SectorCoordinate{-16384, 16384}));
    EXPECT_EQ(bake.settings, bake_request().settings);  // the float to its last bit
    EXPECT_FALSE(bake.earlier);
    BakeRequest request = bake_request();
    request.earlier = {some_digest, map::digest_of(test::bytes_of("footprint")),
                       map::digest_of(test::bytes_of("inventory"))};
    const auto with_earlier =
        std::get<BakeRequest>(decode_request(encode(Request{UINT64_MAX, request})).value().what);
    ASSERT_TRUE(with_earlier.earlier);
    EXPECT_EQ(std::tuple(with_earlier.earlier->file, with_earlier.earlier->footprint,
                         with_earlier.earlier->inventory),
              std::tuple(some_digest, request.earlier->footprint, request.earlier->inventory));
    const auto inspect = std::get<InspectRequest>(
        decode_request(encode(Request{3, InspectRequest{some_digest}})).value().what);
    EXPECT_EQ(inspect.manifest, some_digest);
}

TEST(WorkerProtocol, AssessmentsComeBackAsTheyWere) {
    const map::Digest other = map::digest_of(test::bytes_of("other"));
    AssessRequest request{
        some_digest,
        bake_request().settings,
        {{{1, -2}, {{some_digest, some_digest, other}, {some_digest, other, some_digest}}}, {{3, 4}, {}}}};
    request.settings.tolerance = 0.1f;
    const auto back =
        std::get<AssessRequest>(decode_request(encode(Request{UINT64_MAX, request})).value().what);
    EXPECT_EQ(back.manifest, some_digest);
    EXPECT_EQ(back.settings, request.settings);
    ASSERT_EQ(back.sectors.size(), 2u);
    EXPECT_EQ(back.sectors[0].sector, (map::SectorCoordinate{1, -2}));
    ASSERT_EQ(back.sectors[0].candidates.size(), 2u);
    EXPECT_EQ(back.sectors[0].candidates[1].footprint, other);
    EXPECT_EQ(back.sectors[0].candidates[1].inventory, some_digest);

    Assessments answer;
    answer.sectors = {{reuse::Verdict::near_hit, 1, 0.1f, 0, "why", "w"},
                      {reuse::Verdict::rebake, 0, 0, 0.25f, "because", "be"}};
    answer.changes = {{"a tree moved", {{1, 2, 3}, {4, 5, 6.5f}}}};
    answer.warnings = {"lost"};
    const auto given = std::get<Assessments>(decode_answer(encode(Answer{9, answer})).value().what);
    ASSERT_EQ(given.sectors.size(), 2u);
    EXPECT_EQ(std::tuple(given.sectors[0].verdict, given.sectors[0].candidate, given.sectors[0].bound,
                         given.sectors[0].reason, given.sectors[0].cause),
              std::tuple(reuse::Verdict::near_hit, 1u, 0.1f, "why", "w"));
    EXPECT_EQ(given.sectors[1].share, 0.25f);
    ASSERT_EQ(given.changes.size(), 1u);
    EXPECT_EQ(given.changes[0].bounds.high, glm::vec3(4, 5, 6.5f));
    EXPECT_EQ(given.warnings, answer.warnings);
    EXPECT_FALSE(decode_answer(replaced(encode(Answer{9, answer}), R"("verdict":1)", R"("verdict":3)")));
}

TEST(WorkerProtocol, AnswersComeBackAsTheyWere) {
    const auto round = [](decltype(Answer::what) what) {
        const std::string text = encode(Answer{9, std::move(what)});
        EXPECT_EQ(text.find('\n'), std::string::npos);
        const auto answer = decode_answer(text);
        EXPECT_EQ(answer.value().id, 9u);
        return answer->what;
    };
    const auto baked = std::get<SectorResult>(round(SectorResult{{some_digest, some_digest, some_digest},
                                                                 15000,
                                                                 12,
                                                                 70,
                                                                 1LL << 40,
                                                                 {"a wall"},
                                                                 0.3,
                                                                 0.1f,
                                                                 {1, 2, 3, 4, 5, 6, 0.1, 0.2, 0.3, 7},
                                                                 {0.1, 0.2, 0.3, 0.4, 0.5}}));
    EXPECT_EQ(baked.numbers, (SectorNumbers{1, 2, 3, 4, 5, 6, 0.1, 0.2, 0.3, 7}));
    EXPECT_EQ(baked.stages, (bake::StageSeconds{0.1, 0.2, 0.3, 0.4, 0.5}));
    EXPECT_EQ(std::tuple(baked.footprint_bytes, baked.seconds, baked.bound), std::tuple(12, 0.3, 0.1f));
    EXPECT_EQ(std::tuple(baked.blobs.file, baked.file_bytes, baked.probes, baked.rays),
              std::tuple(some_digest, 15000, 70, 1LL << 40));
    EXPECT_EQ(baked.warnings, std::vector<std::string>{"a wall"});
    const auto failure = std::get<RequestFailure>(round(RequestFailure{"two\nlines, \"quotes\"", true}));
    EXPECT_EQ(failure.sentence, "two\nlines, \"quotes\"");
    EXPECT_TRUE(failure.may_retry);
    MapSummary summary;
    summary.content = some_digest;
    summary.sectors = {{1, -2}, {3, 4}};
    summary.survey.low = {1, 2, 3};
    summary.survey.static_objects = 5;
    summary.survey.down_m2 = 0.25;
    summary.survey.likeness = "ab";
    summary.warnings = {"warned"};
    const auto inspected = std::get<MapSummary>(round(summary));
    EXPECT_EQ(inspected.survey.likeness, "ab");
    EXPECT_EQ(inspected.content, some_digest);
    EXPECT_EQ(inspected.sectors, (std::vector<map::SectorCoordinate>{{1, -2}, {3, 4}}));
    EXPECT_EQ(std::tuple(inspected.survey.low.z, inspected.survey.static_objects, inspected.survey.down_m2),
              std::tuple(3, 5, 0.25));
    EXPECT_EQ(inspected.warnings, std::vector<std::string>{"warned"});
}

TEST(WorkerProtocol, ASentenceThatIsNotUtf8IsStillALine) {
    const auto answer = decode_answer(encode(Answer{1, RequestFailure{"broken \xff\xfe", false}}));
    ASSERT_TRUE(answer);
    EXPECT_TRUE(std::get<RequestFailure>(answer->what).sentence.starts_with("broken "));
}

TEST(WorkerProtocol, GarbageIsNothing) {
    const std::string request = encode(Request{UINT64_MAX, bake_request()}),
                      answer = encode(
                          Answer{9, SectorResult{{some_digest, {}, {}}, 1, 2, 3, 4, {}, 0, 0, {}, {}}});
    for (std::size_t size = 0; size < request.size(); ++size)
        EXPECT_FALSE(decode_request(request.substr(0, size))) << size;
    for (std::size_t size = 0; size < answer.size(); ++size)
        EXPECT_FALSE(decode_answer(answer.substr(0, size))) << size;
    for (const std::string& odd :
         {std::string(), std::string("null"), std::string("[]"), std::string("7"), std::string("{}"),
          std::string(R"({"id":1})"), std::string("\xff"), std::string("\0", 1), std::string(100000, '[')}) {
        EXPECT_FALSE(decode_request(odd)) << odd.substr(0, 20);
        EXPECT_FALSE(decode_answer(odd)) << odd.substr(0, 20);
    }
    EXPECT_FALSE(decode_request(request + "x"));
    EXPECT_FALSE(decode_answer(answer + "x"));
}

TEST(WorkerProtocol, NumbersOutOfRangeAreNothing) {
    const std::string request = encode(Request{UINT64_MAX, bake_request()}),
                      answer = encode(
                          Answer{9, SectorResult{{some_digest, {}, {}}, 1, 2, 3, 4, {}, 0, 0, {}, {}}});
    for (const char* bad : {"4294967296", "2147483648", "1.5", "\"1\"", "null", "1e30", "true"})
        EXPECT_FALSE(decode_request(replaced(request, R"("i":-16384)", std::string(R"("i":)") + bad))) << bad;
    for (const char* bad : {"-1", "4294967296", "17.5", "1e30"})
        EXPECT_FALSE(decode_request(replaced(request, R"("rays":17)", std::string(R"("rays":)") + bad)))
            << bad;
    for (const char* bad : {"-9", "9.0", "18446744073709551616", "\"9\""})
        EXPECT_FALSE(decode_answer(replaced(answer, R"("id":9)", std::string(R"("id":)") + bad))) << bad;
    for (const char* bad : {"9223372036854775808", "0.5", "null"})
        EXPECT_FALSE(
            decode_answer(replaced(answer, R"("file_bytes":1)", std::string(R"("file_bytes":)") + bad)))
            << bad;
}

TEST(WorkerProtocol, AnUnknownRequestIsNothing) {
    EXPECT_FALSE(
        decode_request(replaced(encode(Request{UINT64_MAX, bake_request()}), "\"bake\"", "\"boil\"")));
}

}  // namespace
}  // namespace drtv::worker
