// Reads files as the programs do that read foreign formats, but all in one process, without the walls around those:
// for mutate_foreign.py, with which a build with sanitizers looks at more files than processes can be started for. One
// program for each reader, open_foreign_dicom and so on, which takes paths and answers them, see answer_paths.h.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "answer_paths.h"
#include "foreign/foreign_volume.h"
#include "volume/process/reader_messages.h"

using namespace pellucid;
using nlohmann::json;

namespace {

constexpr std::uint64_t kMostBytes = 64u << 20; ///< of voxels that are read: more is not in these files

/// What is said of a file, its first step, and where that is small its voxels; each message as the asker takes it.
json open(const std::string& path) {
    const BeforeFile before = [](std::uint64_t) {};
    const auto volume = openForeign(path, {}, before);
    const json told = json::parse(jsonOf(ReaderDescription{volume->contents(), volume->files()}).dump());
    const FileContents contents = descriptionIn(told).contents;
    const ReaderLayout layout = layoutIn(json::parse(jsonOf(volume->layout(0)).dump()));
    ReaderBox box;
    box.region = {Int3(0), dimsOf(layout, 0)};
    const std::uint64_t bytes = bytesOf(box, layout, path);
    if (bytes > kMostBytes) throw FileError("there are too many voxels to be read here", path, "");
    std::vector<std::byte> voxels(static_cast<std::size_t>(bytes));
    volume->read(0, box, voxels, before, {});
    return {{"dims", json::array({contents.dims.x, contents.dims.y, contents.dims.z})}};
}

/// As app/reader/main.cpp has it for what libraries throw.
json openOrSay(const std::string& path) {
    try {
        return open(path);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw FileError(std::string("the library that reads this format failed (") + error.what() + ")", path,
                        "the file is damaged: copy it again");
    }
}

} // namespace

int main(int argc, char**) {
    if (argc != 1) {
        std::fprintf(stderr, "usage: open_foreign_KIND, paths on standard input\n");
        return 2;
    }
    test::answerAll(openOrSay);
}
