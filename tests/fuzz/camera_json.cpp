// Cameras.
#include "fuzz_input.h"
#include <nlohmann/json.hpp>

#include "render/camera.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".camera.json", [](const std::string& path) {
        succeeds([&] {
            const Camera camera = readCamera(path);
            require(cameraFromJson(jsonFromCamera(camera), "again") == camera, "a camera is read back as it was");
        });
    });
    return 0;
}
