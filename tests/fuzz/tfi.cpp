// Transfer functions of Voreen.
#include "fuzz_input.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".tfi", [](const std::string& path) {
        succeeds([&] {
            const TransferFunction tf = readTfFile(path);
            const std::string again = s_folder.path("again.tf.json");
            writeTf(tf, again);
            require(readTfFile(again) == tf, "a transfer function is read back as it was");
            writeTfFile({tf, ValueRange{0, 1}, {}, "again"}, s_folder.path("again.paraview.json"));
        });
    });
    return 0;
}
