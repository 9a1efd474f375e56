// Walks the descriptions of all settings: through session files and options they come back, and both refuse what is out
// of range in the same words.
#include <catch2/catch.hpp>

#include <set>

#include <nlohmann/json.hpp>

#include "film/film.h"
#include "options/setting_options.h"
#include "session/session.h"
#include "share/share.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::cli::SettingOptions;

namespace {

/// Values that the setting may have, as texts.
std::vector<std::string> goodValues(const Setting& setting, const SettingValue& value) {
    std::vector<std::string> texts;
    if (setting.none != nullptr) texts.emplace_back(setting.none);
    if (const auto* choice = std::get_if<Choice>(&value)) {
        texts.insert(texts.end(), choice->names.begin(), choice->names.end());
    } else if (std::holds_alternative<bool*>(value)) {
        texts = {"true", "false"};
    } else if (std::holds_alternative<std::string*>(value)) {
        texts = {"ember"};
    } else if (!isNumber(value)) {
        texts.insert(texts.end(), {"#102030", "0.1,0.25,0.7"});
    } else {
        const NumberRange& r = setting.range;
        const double hi = std::min(r.hi, 1e12), inside = std::holds_alternative<int*>(value) ? 1 : 1e-3;
        for (const double number : {r.lo, r.lo + inside, hi - inside, hi})
            if (r.holds(number)) texts.push_back(json(number).dump());
        if (std::holds_alternative<int*>(value))
            for (std::string& text : texts) text = text.substr(0, text.find('.'));
    }
    return texts;
}

/// Numbers that it may not have.
std::vector<double> badNumbers(const Setting& setting) {
    constexpr double kExact = 1e15; // beyond, adding 1 changes nothing
    const NumberRange& r = setting.range;
    std::vector<double> numbers{r.lo > -kExact ? r.lo - 1 : 10 * r.lo};
    if (r.hi < NumberRange::kFinite) numbers.push_back(r.hi < kExact ? r.hi + 1 : 10 * r.hi);
    if (setting.range.open == NumberRange::Open::Low) numbers.push_back(setting.range.lo);
    if (setting.range.open == NumberRange::Open::High) numbers.push_back(setting.range.hi);
    return numbers;
}

/// What the setting's option makes of the text; empty words: it was taken.
template <class T>
std::string byOption(const Setting& setting, const std::string& text, T& values) {
    CLI::App app;
    app.set_help_flag();
    SettingOptions<T> options;
    options.add(app, "Options", {setting.key});
    const bool isFlag = std::holds_alternative<bool*>(setting.at(&values));
    std::vector<std::string> words{setting.optionName()};
    if (isFlag && (text == "false") != words.front().starts_with("--no-"))
        words.clear(); // what the flag does not say
    else if (!isFlag)
        words.insert(words.begin(), text); // CLI11 takes them from the back
    try {
        app.parse(std::vector<std::string>(words)); // which takes them away
    } catch (const UsageError& e) {
        CHECK(e.where() == setting.optionName());
        return e.problem() + " | " + e.whatToDo();
    }
    CHECK(options.has(setting.key) == !words.empty());
    options.applyTo(values);
    return {};
}

std::string byFile(const Setting& setting, const json& value, void* values, std::span<const Setting> settings) {
    const json document{{setting.key, value}};
    try {
        takeSettings(JsonValue(document, "s.json"), settings, values);
    } catch (const Error& e) {
        CHECK(e.where() == std::string("s.json at /") + setting.key);
        return e.problem() + " | " + e.whatToDo();
    }
    return {};
}

template <class T>
void walk() {
    std::set<std::string> keys;
    for (const Setting& setting : settingsOf<T>()) {
        INFO(setting.key);
        CHECK(keys.insert(setting.key).second);
        const std::string help = setting.help;
        CHECK((help.size() > 10 && help.ends_with('.') && help.find("  ") == std::string::npos));
        CHECK_FALSE(setting.name().empty());
        const T usual;
        CHECK_NOTHROW(check(setting, &usual));
        const SettingValue value = setting.at(const_cast<T*>(&usual));
        for (const std::string& text : goodValues(setting, value)) {
            INFO(text);
            T wanted, read, given;
            setText(setting, &wanted, text);
            CHECK_NOTHROW(check(setting, &wanted));
            json document = json::object();
            putSettings(document, wanted);
            takeSettings(JsonValue(document, "s.json"), read);
            CHECK(textOf(setting, &read) == textOf(setting, &wanted));
            if (setting.optionName().empty()) continue;
            CHECK(byOption(setting, text, given) == "");
            // A flag says one of the two values.
            if (!std::holds_alternative<bool*>(value) || setting.optionName().starts_with("--no-") == (text == "false"))
                CHECK(textOf(setting, &given) == textOf(setting, &wanted));
        }
        if (const auto* choice = std::get_if<Choice>(&value)) {
            T a, b;
            const std::string words = byFile(setting, "nothing of the kind", &a, settingsOf<T>());
            CHECK(words.find(choice->names.back()) != std::string::npos);
            if (!setting.optionName().empty()) CHECK(byOption(setting, "nothing of the kind", b) == words);
            CHECK((setting.choices.empty() || setting.choices.size() == choice->names.size()));
        }
        if (!isNumber(value)) continue;
        for (const double number : badNumbers(setting)) {
            INFO(number);
            const bool isWhole = std::holds_alternative<int*>(value);
            const json inFile = isWhole ? json(static_cast<std::int64_t>(number)) : json(number);
            T a, b;
            const std::string words = byFile(setting, inFile, &a, settingsOf<T>());
            CHECK(words.find("is out of range | give ") != std::string::npos);
            CHECK(words.find(setting.range.text()) != std::string::npos);
            if (!setting.optionName().empty()) CHECK(byOption(setting, inFile.dump(), b) == words);
        }
    }
}

} // namespace

TEST_CASE("every setting goes through every door, and each refuses in the same words", "[cli][setting]") {
    walk<OptimizeOptions>();
    walk<SaliencyOptions>();
    walk<VwsOptions>();
    walk<MeasureSettings>();
    walk<RefineSteps>();
    walk<RefineSettings>();
    walk<AdaptSettings>();
    walk<Light>();
    walk<DisplaySettings>();
    walk<FieldView>();
    walk<GroundView>();
    walk<OverlayView>();
    walk<SliceViews>();
    walk<CoordinateSettings>();
    walk<FilmSettings>();
    walk<ShareSettings>();
    walk<PictureSaliencyView>();
    walk<ComparisonView>();
    walk<HsbMapping>();
}
