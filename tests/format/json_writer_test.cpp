// JsonWriter read back by nlohmann_json.
#include "format/kit/json_writer.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace drtv::kit {
namespace {

std::string json_of(std::string_view text) {
    JsonWriter json;
    json.value(text);
    return json.text();
}

TEST(JsonWriter, NestedValuesHaveCommasBetweenThemOnly) {
    JsonWriter json;
    json.begin_object().key("a").value(1).key("b").begin_array().end_array();
    json.key("c")
        .begin_array()
        .value(true)
        .begin_object()
        .end_object()
        .begin_array()
        .value("x")
        .value(-2)
        .end_array()
        .end_array();
    json.key("d").begin_object().key("e").value(false).key("f").value(2.5).end_object().end_object();
    EXPECT_EQ(json.text(), R"({"a":1,"b":[],"c":[true,{},["x",-2]],"d":{"e":false,"f":2.5}})");
    EXPECT_TRUE(nlohmann::json::accept(json.text()));
}

TEST(JsonWriter, RangeBecomesAnArray) {
    JsonWriter json;
    json.array(std::array<float, 3>{1, 0.1f, -0.5f});
    EXPECT_EQ(json.text(), "[1,0.1,-0.5]");
}

TEST(JsonWriter, EveryByteOfATextComesBack) {
    std::string text;
    for (int byte = 0; byte < 128; ++byte)
        text += static_cast<char>(byte);
    text += "Grüße, 草, 🌲";
    EXPECT_EQ(nlohmann::json::parse(json_of(text)).get<std::string>(), text);
}

TEST(JsonWriter, KeysAreQuotedToo) {
    JsonWriter json;
    json.begin_object().key("a\"b\n").value(1).end_object();
    EXPECT_EQ(nlohmann::json::parse(json.text())["a\"b\n"], 1);
}

TEST(JsonWriter, BytesThatAreNotUtf8BecomeReplacementCharacters) {
    EXPECT_EQ(json_of("a\xff"
                      "b"),
              R"("a\ufffdb")");
    for (std::string_view wrong : {"\x80", "\xc3", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80",
                                   "\xf4\x90\x80\x80", "\xf0\x80\x80\x80", "\xe8\x8d", "\xc3(", "\xfe"}) {
        EXPECT_TRUE(nlohmann::json::accept(json_of(wrong))) << json_of(wrong);
        EXPECT_NE(json_of(wrong).find("\\ufffd"), std::string::npos);
    }
}

TEST(JsonWriter, RandomBytesAlwaysGiveJson) {
    std::mt19937 random(1);
    for (int n = 0; n < 5000; ++n) {
        std::string text;
        for (std::uint32_t k = 0; k < random() % 12; ++k)
            text += static_cast<char>(random() % 3 == 0 ? 0x80 + random() % 0x80 : random() % 256);
        ASSERT_TRUE(nlohmann::json::accept(json_of(text))) << json_of(text);
    }
}

TEST(JsonWriter, FloatsComeBackToTheBit) {
    std::mt19937 random(2);
    for (int n = 0; n < 20'000; ++n) {
        const float number = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(number))
            continue;
        JsonWriter json;
        json.value(number);
        ASSERT_EQ(std::strtof(json.text().c_str(), nullptr), number) << json.text();
        ASSERT_TRUE(nlohmann::json::accept(json.text())) << json.text();
    }
}

TEST(JsonWriter, NumbersThatJsonDoesNotKnowAreNull) {
    JsonWriter json;
    json.begin_array()
        .value(std::numeric_limits<float>::quiet_NaN())
        .value(std::numeric_limits<double>::infinity())
        .end_array();
    EXPECT_EQ(json.text(), "[null,null]");
}

TEST(JsonWriter, IntegersAreExact) {
    JsonWriter json;
    json.begin_array()
        .value(std::uint64_t{UINT64_MAX})
        .value(std::int64_t{INT64_MIN})
        .value(0)
        .value(7u)
        .end_array();
    EXPECT_EQ(json.text(), "[18446744073709551615,-9223372036854775808,0,7]");
}

}  // namespace
}  // namespace drtv::kit
