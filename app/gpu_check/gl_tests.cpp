#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "gl_tests.h"

#include <algorithm>
#include <tuple>

namespace pellucid::gpu_check {

namespace {

constexpr std::size_t kMostFailures = 20, kMostCharacters = 1000; ///< of one test, and of one of its failures

/// What the collector has found; Catch makes and deletes the collector itself.
std::vector<std::string>& failures() {
    static std::vector<std::string> all;
    return all;
}

/// Keeps what fails: "image_test.cpp:61: CHECK( x == 1 ): 2 == 1; the messages around it".
class Collector : public Catch::StreamingReporterBase<Collector> {
public:
    using StreamingReporterBase::StreamingReporterBase;
    static std::string getDescription() { return "keeps failures"; }
    void assertionStarting(const Catch::AssertionInfo&) override {}
    bool assertionEnded(const Catch::AssertionStats& stats) override {
        const Catch::AssertionResult& result = stats.assertionResult;
        if (result.isOk() || failures().size() >= kMostFailures) return true;
        std::string file = result.getSourceInfo().file;
        file.erase(0, file.rfind('/') + 1);
        std::string text = file + ":" + std::to_string(result.getSourceInfo().line) + ": ";
        if (result.hasExpression()) text += result.getExpressionInMacro() + ": " + result.getExpandedExpression();
        if (result.hasMessage()) text += " " + std::string(result.getMessage());
        for (const Catch::MessageInfo& message : stats.infoMessages)
            if (message.message != result.getMessage()) text += "; " + message.message;
        if (text.size() > kMostCharacters) text.resize(kMostCharacters);
        failures().push_back(std::move(text));
        return true;
    }
};
CATCH_REGISTER_REPORTER("collector", Collector)

bool hasTag(const Catch::TestCase& test, std::initializer_list<const char*> tags) {
    return std::any_of(tags.begin(), tags.end(), [&](const char* tag) {
        return std::find(test.tags.begin(), test.tags.end(), tag) != test.tags.end();
    });
}

/// The name as Catch's command line takes it.
std::string quoted(const std::string& name) {
    std::string text;
    for (const char c : name) {
        if (std::string("\\,[\"*").find(c) != std::string::npos) text += '\\';
        text += c;
    }
    return text;
}

} // namespace

std::vector<GlTest> glTests() {
    std::vector<const Catch::TestCase*> found;
    for (const Catch::TestCase& test : Catch::getRegistryHub().getTestCaseRegistry().getAllTests())
        if (!test.isHidden() && !hasTag(test, {"real", "files"})) found.push_back(&test);
    std::sort(found.begin(), found.end(), [](const auto* a, const auto* b) {
        return std::tuple(std::string(a->lineInfo.file), a->lineInfo.line) <
               std::tuple(std::string(b->lineInfo.file), b->lineInfo.line);
    });
    std::vector<GlTest> all;
    for (const Catch::TestCase* test : found) all.push_back({test->name, hasTag(*test, {"accuracy", "orbit", "slow"})});
    return all;
}

Json runGlTest(const std::string& name) {
    Catch::Session session;
    Catch::ConfigData config;
    config.testsOrTags.push_back(quoted(name));
    config.reporterName = "collector";
    config.warnings = Catch::WarnAbout::NoTests;
    session.useConfigData(config);
    const int status = session.run();
    if (status != 0 && failures().empty()) failures().push_back("Catch ended with status " + std::to_string(status));
    return {{"passed", failures().empty()}, {"failures", failures()}};
}

} // namespace pellucid::gpu_check
