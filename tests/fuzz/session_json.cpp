// Sessions.
#include "session/session_json.h"
#include "fuzz_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".pellucid.json", [](const std::string& path) {
        succeeds([&] {
            const Session session = readSession(path).session;
            const std::string again = s_folder.path("again.pellucid.json");
            writeSession(session, again);
            require(readSession(again).session == session, "a session is read back as it was");
        });
    });
    return 0;
}
