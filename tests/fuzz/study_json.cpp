// Studies.
#include "fuzz_input.h"
#include "study/study.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".study.json", [](const std::string& path) {
        succeeds([&] {
            const Study study = readStudy(path);
            const std::string again = s_folder.path("again.study.json");
            writeStudy(study, again);
            require(readStudy(again) == study, "a study is read back as it was");
        });
    });
    return 0;
}
