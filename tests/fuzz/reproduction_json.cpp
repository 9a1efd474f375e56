// What reproduce keeps of a figure.
#include <nlohmann/json.hpp>

#include "base/json_file.h"
#include "fuzz_input.h"
#include "report/reproduction.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".json", [](const std::string& path) {
        succeeds([&] {
            const Reproduction item = reproductionFromJson(readJson(path), path);
            const nlohmann::json again = jsonFromReproduction(item);
            require(reproductionFromJson(again, "again") == item, "a figure is read back as it was");
        });
    });
    return 0;
}
