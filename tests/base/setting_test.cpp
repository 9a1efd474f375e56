// A description of a setting is all that files and options need.
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "base/setting.h"

namespace pellucid {

enum class Fruit { Apple, Pear };
template <>
inline constexpr auto kNamesOf<Fruit> = enumNames("fruit", "apple", "pear");

struct Inner {
    double weight = 0.25;
};
struct Basket {
    bool open = false;
    int count = 3;
    Inner inner;
    std::optional<double> price = 1.5;
    std::string owner = "nobody";
    Rgb color{1, 0, 0};
    std::optional<Rgb> lid;
    Fruit fruit = Fruit::Apple;
    std::optional<Fruit> second;
};

template <>
std::span<const Setting> settingsOf<Basket>() {
    using Open = NumberRange::Open;
    static const Setting kSettings[] = {
        {.key = "open", .at = member<&Basket::open>, .words = "&Open", .help = "Leaves the basket open."},
        {.key = "count", .at = member<&Basket::count>, .words = "Count", .help = "How many.", .range = {0, 9}},
        {.key = "weight",
         .at = member<&Basket::inner, &Inner::weight>,
         .words = "Weight",
         .help = "How heavy one is.",
         .range = {0, 2, Open::Low},
         .unit = "kg"},
        {.key = "price",
         .at = member<&Basket::price>,
         .words = "Price",
         .help = "What one costs.",
         .range = {0, NumberRange::kInfinity},
         .none = "unknown"},
        {.key = "owner",
         .at = member<&Basket::owner>,
         .words = "Owner",
         .help = "Whose it is.",
         .checkText =
             [](const std::string& text) {
                 if (text.empty()) throw UsageError("an owner has a name", "", "give one");
             }},
        {.key = "color", .at = member<&Basket::color>, .words = "Colour", .help = "Its colour."},
        {.key = "lid", .at = member<&Basket::lid>, .words = "Lid", .help = "The lid's colour."},
        {.key = "fruit", .at = member<&Basket::fruit>, .words = "Fruit", .help = "What is in it."},
        {.key = "second", .at = member<&Basket::second>, .words = "Second", .help = "And what.", .none = "nothing"},
    };
    return kSettings;
}

namespace {

using nlohmann::json;

const Setting& of(const char* key) { return settingOf(settingsOf<Basket>(), key); }

std::string wordsOf(const Error& e) { return e.problem() + " | " + e.whatToDo(); }

/// What is said against a value in a file, and as a text; they are the same.
std::string refusal(const char* key, const json& value, const std::string& text) {
    Basket basket;
    std::string inFile, asText;
    const json document{{key, value}};
    try {
        takeSettings(JsonValue(document, "b.json"), basket);
    } catch (const Error& e) {
        CHECK(e.where() == std::string("b.json at /") + key);
        inFile = wordsOf(e);
    }
    try {
        setText(of(key), &basket, text);
    } catch (const UsageError& e) {
        asText = wordsOf(e);
    }
    CHECK(inFile == asText);
    return asText;
}

} // namespace

TEST_CASE("settings of every kind come back from a file and from their texts", "[setting]") {
    Basket basket;
    basket.open = true;
    basket.count = 7;
    basket.inner.weight = 0.1 + 0.2; // all bits
    basket.price.reset();
    basket.owner = "somebody";
    basket.color = {0.1, 1.0 / 3, 0.7}; // no eight bits hold it
    basket.lid = Rgb{0, 1, 0};
    basket.fruit = Fruit::Pear;
    basket.second = Fruit::Apple;
    json document = json::object();
    putSettings(document, basket);
    CHECK(document["price"] == "unknown"); // else it would be 1.5 again
    CHECK(document["lid"] == "#00ff00");
    Basket read, typed;
    takeSettings(JsonValue(document, "b.json"), read);
    for (const Setting& setting : settingsOf<Basket>()) {
        INFO(setting.key);
        setText(setting, &typed, textOf(setting, &basket));
        CHECK(textOf(setting, &read) == textOf(setting, &basket));
        CHECK(textOf(setting, &typed) == textOf(setting, &basket));
        Basket copy;
        copyValue(setting, &basket, &copy);
        CHECK(textOf(setting, &copy) == textOf(setting, &basket));
    }
    CHECK(read.inner.weight == basket.inner.weight);
    CHECK(typed.inner.weight == basket.inner.weight);
    CHECK(read.color == basket.color);
    CHECK(typed.color == basket.color);
}

TEST_CASE("what a file does not have stays, and what is empty as usual is left out", "[setting]") {
    json document = json::object();
    putSettings(document, Basket{});
    CHECK_FALSE(document.contains("lid"));
    CHECK_FALSE(document.contains("second"));
    Basket basket;
    basket.count = 5;
    const json empty = json::object();
    takeSettings(JsonValue(empty, "b.json"), basket);
    CHECK(basket.count == 5);
}

TEST_CASE("a number without end is a word in files", "[setting]") {
    Basket basket;
    basket.price = NumberRange::kInfinity;
    json document = json::object();
    putSettings(document, basket);
    CHECK(document["price"] == "infinite");
    CHECK(textOf(of("price"), &basket) == "inf");
    Basket read;
    takeSettings(JsonValue(document, "b.json"), read);
    CHECK(read.price == NumberRange::kInfinity);
    const json wrong{{"weight", "infinite"}};
    CHECK_THROWS_AS(takeSettings(JsonValue(wrong, "b.json"), read), Error);
}

TEST_CASE("files and options refuse a value in the same words", "[setting]") {
    CHECK(refusal("count", 10, "10") == "10 is out of range | give a whole number from 0 to 9");
    CHECK(refusal("weight", 0, "0") == "0 is out of range | give a number above 0 and up to 2");
    CHECK(refusal("price", -1, "-1") == "-1 is out of range | give a number from 0 on or unknown");
    CHECK(refusal("fruit", "plum", "plum") == "there is no fruit 'plum' | give apple or pear");
    CHECK(refusal("second", "plum", "plum") == "there is no fruit 'plum' | give apple, pear or nothing");
    CHECK(refusal("owner", "", "") == "an owner has a name | give one");
    Basket basket;
    for (const auto& [key, text] : {std::pair{"count", "2.5"},
                                    {"count", ""},
                                    {"count", "99999999999999"},
                                    {"weight", "nan"},
                                    {"weight", "inf"},
                                    {"weight", "1kg"},
                                    {"open", "yes"},
                                    {"color", "1,2,3"},
                                    {"color", "red"},
                                    {"lid", "#12345"}}) {
        INFO(key << " " << text);
        CHECK_THROWS_AS(setText(of(key), &basket, text), UsageError);
    }
    for (const auto& [key, value] : {std::pair<const char*, json>{"count", 2.5},
                                     {"count", "3"},
                                     {"count", 99999999999999},
                                     {"weight", "1"},
                                     {"weight", true},
                                     {"open", 1},
                                     {"fruit", 0},
                                     {"owner", nullptr},
                                     {"color", {1, 2, 3}}}) {
        const json document{{key, value}};
        INFO(document);
        CHECK_THROWS_AS(takeSettings(JsonValue(document, "b.json"), basket), Error);
    }
}

TEST_CASE("values that programs set are checked too", "[setting]") {
    Basket basket;
    CHECK_NOTHROW(checkSettings(basket, "basket"));
    basket.inner.weight = std::nan("");
    CHECK_THROWS_WITH(checkSettings(basket, "basket"), Catch::Contains("Weight: nan is out of range, basket"));
}

TEST_CASE("people read settings with units, and options have names", "[setting]") {
    const Basket basket;
    CHECK(shownText(of("weight"), &basket) == "0.25 kg");
    CHECK(shownText(of("open"), &basket) == "no");
    CHECK(of("open").name() == "Open");
    CHECK(of("weight").optionName() == "--weight");
    CHECK(NumberRange{0, 1, NumberRange::Open::High}.text() == "from 0 to below 1");
    CHECK(NumberRange{0, NumberRange::kFinite, NumberRange::Open::Low}.text() == "above 0");
}

} // namespace pellucid
