// pellucid-reader, pellucid-image-reader and pellucid-array-reader: each reads files of formats whose library it has,
// for the program that has started it (volume/process/reader_process.h). Its standard input says what to read; voxels
// go to the file number 3.
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>
#include <sys/mman.h>

#include "confinement.h"
#include "foreign/foreign_volume.h"
#include "volume/process/reader_messages.h"

namespace pellucid::reader {

namespace {

constexpr int kVoxels = 3;
constexpr std::uint64_t kSpare = 256u << 20; ///< for libraries, besides what files and voxels take

/// Texts of files need not be UTF-8.
void say(const nlohmann::json& message) {
    std::cout << message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n" << std::flush;
}

/// Memory for the voxels, which is the asker's. The system hands it out piece by piece, a little before it is written:
/// one call for many pages costs less than as many faults, and nothing is taken for voxels that never come.
class Voxels {
public:
    explicit Voxels(std::uint64_t bytes) : m_bytes(bytes) {
        m_at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, kVoxels, 0);
        if (m_at == MAP_FAILED) throw FileError("there is no memory for the voxels", "", "use a smaller volume");
    }
    ~Voxels() { munmap(m_at, m_bytes); }
    Voxels(const Voxels&) = delete;
    Voxels& operator=(const Voxels&) = delete;
    std::span<std::byte> bytes() const { return {static_cast<std::byte*>(m_at), m_bytes}; }
    /// So many have been written, from the beginning on.
    void advance(std::size_t written) {
        constexpr std::size_t kAhead = std::size_t{4} << 20;
        if (written + kAhead / 2 < m_ready || m_ready == m_bytes) return;
        const std::size_t next = std::min(m_bytes, (written + 2 * kAhead) / kAhead * kAhead);
        // An older kernel does not know it: then pages come one by one.
        madvise(static_cast<std::byte*>(m_at) + m_ready, next - m_ready, MADV_POPULATE_WRITE);
        m_ready = next;
    }

private:
    void* m_at;
    std::size_t m_bytes, m_ready = 0;
};

/// Of a box of so many bytes.
JobControl progressTeller(Voxels& voxels, std::uint64_t bytes) {
    voxels.advance(0);
    return {{}, [&voxels, bytes, last = -1.0](double done) mutable {
                voxels.advance(static_cast<std::size_t>(std::clamp(done, 0.0, 1.0) * static_cast<double>(bytes)));
                if (done < last + 0.01) return;
                last = done;
                say({{"progress", done}});
            }};
}

/// Time and memory by what has to be read: a library has a file as it is and unpacked, and we have it once more.
class Limits {
public:
    void setVoxels(std::uint64_t bytes) { m_voxels = bytes; } ///< that are mapped
    void setImage(std::uint64_t bytes) { m_most = std::max(m_most, bytes); }
    void beforeFile(std::uint64_t bytes) {
        m_most = std::max(m_most, bytes);
        limitTime(bytes);
        limitMemory(m_voxels + 4 * m_most + kSpare);
    }

private:
    std::uint64_t m_voxels = 0, m_most = 0;
};

void answer(const ReaderRequest& request) {
    confineTo(folderToRead(request.path));
    Limits limits;
    const BeforeFile before = [&](std::uint64_t bytes) { limits.beforeFile(bytes); };
    before(0);
    const std::unique_ptr<ForeignVolume> volume = openForeign(request.path, request.array, before);
    if (request.task == ReaderRequest::Task::Describe)
        return say(jsonOf(ReaderDescription{volume->contents(), volume->files()}));
    const ReaderLayout layout = volume->layout(request.step);
    say(jsonOf(layout));
    limits.setImage(volume->largestImageBytes());
    std::optional<Voxels> room;
    for (std::string line; std::getline(std::cin, line);) { // until nobody wants more
        const ReaderBox box = boxIn(nlohmann::json::parse(line, nullptr, false));
        const std::uint64_t bytes = bytesOf(box, layout, request.path);
        // Kept from box to box, of which the first and the last may be smaller; it counts as long as it is mapped.
        const std::uint64_t mapped = room ? std::max<std::uint64_t>(room->bytes().size(), bytes) : bytes;
        limits.setVoxels(mapped);
        before(0);
        if (!room || room->bytes().size() < mapped) room.emplace(mapped);
        volume->read(request.step, box, room->bytes().first(bytes), before, progressTeller(*room, bytes));
        say({{"done", true}});
    }
}

} // namespace

} // namespace pellucid::reader

int main() {
    using namespace pellucid;
    std::string path;
    try {
        std::string line;
        if (!std::getline(std::cin, line)) {
            std::cerr << "pellucid-reader is started by Pellucid; open files with pellucid or pellucid-cli\n";
            return 2;
        }
        const ReaderRequest request = requestIn(nlohmann::json::parse(line, nullptr, false));
        path = request.path;
        reader::answer(request);
        return 0;
    } catch (const Error& error) {
        reader::say(jsonOf(error));
    } catch (const std::bad_alloc&) {
        reader::say(jsonOf(FileError("reading it takes more memory than its size justifies", path,
                                     "the file is damaged: copy it again")));
    } catch (const std::exception& error) {
        reader::say(jsonOf(FileError(std::string("the library that reads this format failed (") + error.what() + ")",
                                     path, "the file is damaged: copy it again")));
    }
    return 1;
}
