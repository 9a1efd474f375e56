// What programs that read foreign formats answer, and what they are asked: lines of JSON.
#include <nlohmann/json.hpp>

#include "fuzz_input.h"
#include "volume/process/reader_messages.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

void readLayout(const nlohmann::json& message) {
    const ReaderLayout answer = layoutIn(message);
    const FileContents contents = contentsOf(answer.layout);
    require(contents.components >= 1 && contents.steps >= 1, "there is something to choose");
    for (int level = 0; level <= static_cast<int>(answer.levels.size()); ++level) {
        const ReaderBox all{level, {Int3(0), dimsOf(answer, level)}, 0};
        require(bytesOf(all, answer, "") > 0, "a level has bytes");
    }
    require(jsonOf(layoutIn(jsonOf(answer))) == jsonOf(answer), "a layout is read back as it was");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const nlohmann::json message = nlohmann::json::parse(data, data + size, nullptr, false);
    // As whoever hears the answers.
    if (message.is_object()) {
        succeeds([&] { descriptionIn(message); });
        succeeds([&] { readLayout(message); });
        succeeds([&] { throwErrorIn(message); });
    }
    // As the programs that are asked, which take any JSON.
    succeeds([&] { requestIn(message); });
    succeeds([&] { require(jsonOf(boxIn(message)).is_object(), "a box is an object"); });
    return 0;
}
