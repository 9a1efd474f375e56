#include "volume/process/reader_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "base/mapped_file.h"
#include "base/memory.h"
#include "base/stopwatch.h"
#include "volume/excerpt.h"

extern char** environ;

namespace pellucid {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Without a word for so long it is ended: it tells of every file that it has read.
constexpr double kMostSilentSeconds = 120;
constexpr std::size_t kMostLine = 64u << 20;
constexpr const char* kCopyAgain = "the file is damaged, or not what it says it is: copy it again";
/// Voxels that are read only where somebody has said so: a short header can claim any number.
constexpr std::size_t kMostUnasked = std::size_t{1} << 37;
/// Voxels that files with coarser copies are opened with where nobody has said how many.
constexpr std::size_t kFirstLook = std::size_t{1} << 25;
/// What the voxels are called in the reader: the number of its file.
constexpr int kVoxelsThere = 3;

fs::path& chosenProgram() {
    static fs::path program;
    return program;
}

fs::path readerProgram(const std::string& name) {
    if (!chosenProgram().empty()) return chosenProgram();
    std::error_code ec;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
    const fs::path installed = folder / PELLUCID_LIBRARIES_FROM_PROGRAMS / name;
    // The last one is for programs of others, which may be anywhere.
    for (const fs::path& program : {folder / name, installed, fs::path(PELLUCID_LIBRARIES_INSTALLED) / name})
        if (fs::exists(program, ec)) return program;
    return installed;
}

/// The number of an open file.
class OpenFile {
public:
    OpenFile() = default;
    explicit OpenFile(int number) : m_number(number) {}
    ~OpenFile() {
        if (m_number >= 0) ::close(m_number);
    }
    OpenFile(OpenFile&& other) noexcept : m_number(std::exchange(other.m_number, -1)) {}
    OpenFile& operator=(OpenFile&& other) noexcept {
        std::swap(m_number, other.m_number);
        return *this;
    }
    int number() const { return m_number; }

private:
    int m_number = -1;
};

[[noreturn]] void failToStart(const fs::path& program, const std::string& why) {
    std::error_code ec;
    const bool isApart = program.filename() == "pellucid-image-reader" && !fs::exists(program, ec);
    throw FileError("the program that reads this format cannot be started (" + why + ")", program.string(),
                    isApart ? "install the package pellucid-images"
                            : "close other programs, or install Pellucid again");
}

/// Two ends of a pipe, closed in programs that are started meanwhile.
struct Pipe {
    OpenFile out, in; ///< to be read from, to be written to
    explicit Pipe(const fs::path& program) {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) failToStart(program, std::generic_category().message(errno));
        out = OpenFile(ends[0]);
        in = OpenFile(ends[1]);
    }
};

/// One pellucid-reader at work. It ends with this.
class Reader {
public:
    Reader(const ReaderRequest& request, const JobControl& job)
        : m_program(readerProgram(request.program)), m_path(request.path), m_job(job) {
        m_voxels = OpenFile(::memfd_create("pellucid voxels", MFD_CLOEXEC | MFD_ALLOW_SEALING));
        if (m_voxels.number() < 0) failToStart(m_program, std::generic_category().message(errno));
        Pipe to(m_program), from(m_program);
        start(to.out.number(), from.in.number());
        m_to = std::move(to.in);
        m_from = std::move(from.out);
    }
    ~Reader() {
        if (m_process > 0) end();
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    void say(const std::string& line) {
        const std::string text = line + "\n";
        for (std::size_t done = 0; done < text.size();) {
            // It may be gone: then the answer tells, and no signal ends this program.
            const ssize_t count = writeQuietly(text.data() + done, text.size() - done);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) return;
            done += static_cast<std::size_t>(count);
        }
    }

    /// The next message that is no progress, which `report` is told of. Throws what the reader says is wrong, and
    /// Cancelled.
    json hear(const JobControl& report) {
        for (;;) {
            const std::string line = nextLine();
            json message = json::parse(line, nullptr, false);
            if (!message.is_object()) failSuddenly("it does not say anything that can be understood");
            if (message.contains("error")) throwErrorIn(message);
            if (!message.contains("progress")) return message;
            if (message["progress"].is_number()) report.report(std::clamp(message["progress"].get<double>(), 0.0, 1.0));
        }
    }

    /// Room for the voxels of each box, which stays as it is.
    void makeRoom(std::uint64_t bytes) {
        if (::ftruncate(m_voxels.number(), static_cast<off_t>(bytes)) != 0) {
            if (errno == EFBIG) // it is no file on a disk, but counts as one
                throw FileError("the limit on the size of files leaves no room for the voxels, " + describeBytes(bytes),
                                m_path, "raise it, as `ulimit -f unlimited` does in a shell");
            throw FileError("there is no memory for the voxels (" + std::generic_category().message(errno) + ")",
                            m_path, "close other programs", Remedy::AllowMoreMemory);
        }
        ::fcntl(m_voxels.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW);
    }

    /// Has a box written, from the beginning of the room.
    void read(const ReaderBox& box, const JobControl& report) {
        say(jsonOf(box).dump());
        hear(report);
    }

    std::string voxels() const { return "/proc/self/fd/" + std::to_string(m_voxels.number()); }

private:
    void start(int in, int out) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0); // libraries talk
        posix_spawn_file_actions_adddup2(&actions, m_voxels.number(), kVoxelsThere);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        sigset_t none;
        sigemptyset(&none);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
        const std::string program = m_program.string();
        std::string name = m_program.filename().string();
        char* const words[] = {name.data(), nullptr};
        const int failure = posix_spawn(&m_process, program.c_str(), &actions, &attributes, words, environ);
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
        if (failure == 0) return;
        m_process = -1;
        failToStart(m_program, std::generic_category().message(failure));
    }

    void end() {
        ::kill(m_process, SIGKILL);
        waitForEnd();
    }
    /// How it ended.
    int waitForEnd() {
        int status = 0;
        while (::waitpid(m_process, &status, 0) < 0 && errno == EINTR) {
        }
        m_process = -1;
        return status;
    }

    ssize_t writeQuietly(const char* text, std::size_t bytes) {
        sigset_t pipe, before;
        sigemptyset(&pipe);
        sigaddset(&pipe, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &pipe, &before);
        const ssize_t count = ::write(m_to.number(), text, bytes);
        const int problem = errno;
        if (count < 0 && problem == EPIPE && sigismember(&before, SIGPIPE) == 0) {
            const timespec now{0, 0};
            ::sigtimedwait(&pipe, nullptr, &now);
        }
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
        errno = problem;
        return count;
    }

    /// Throws where the reader has ended, or is ended because it says nothing.
    std::string nextLine() {
        const Stopwatch silence;
        for (;;) {
            if (const std::size_t end = m_heard.find('\n'); end != std::string::npos) {
                std::string line = m_heard.substr(0, end);
                m_heard.erase(0, end + 1);
                return line;
            }
            if (m_heard.size() > kMostLine) failSuddenly("it says too much");
            if (silence.seconds() > kMostSilentSeconds) failSuddenly("it takes too long");
            m_job.throwIfStopped();
            pollfd waiting{m_from.number(), POLLIN, 0};
            if (::poll(&waiting, 1, 50) <= 0) continue;
            std::array<char, 65536> buffer{};
            const ssize_t count = ::read(m_from.number(), buffer.data(), buffer.size());
            if (count > 0) m_heard.append(buffer.data(), static_cast<std::size_t>(count));
            if (count == 0) failAtItsEnd();
        }
    }

    [[noreturn]] void failSuddenly(const std::string& why) const {
        throw FileError("the program that reads this format was ended: " + why, m_path, kCopyAgain);
    }
    [[noreturn]] void failAtItsEnd() {
        const int status = waitForEnd(); // it has closed its end, and is about to be gone
        if (WIFEXITED(status) && WEXITSTATUS(status) == 127) failToStart(m_program, "a library is missing");
        if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
            throw TakesTooLong("the program that reads this format was ended: the file takes too long to read", m_path,
                               kCopyAgain);
        throw FileError("the program that reads this format crashed on it" +
                            (WIFSIGNALED(status) ? " (signal " + std::to_string(WTERMSIG(status)) + ")"
                                                 : " (status " + std::to_string(WEXITSTATUS(status)) + ")"),
                        m_path, "the file is damaged: copy it again, or convert it with another program");
    }

    const fs::path m_program;
    const std::string m_path;
    const JobControl& m_job;
    OpenFile m_voxels, m_to, m_from;
    pid_t m_process = -1;
    std::string m_heard;
};

ReaderRequest withTask(ReaderRequest request, ReaderRequest::Task task) {
    request.task = task;
    return request;
}

} // namespace

void setReaderProgram(const fs::path& program) { chosenProgram() = program; }

ReaderDescription describeInProcess(const ReaderRequest& request, const JobControl& job) {
    Reader reader(request, job);
    reader.say(jsonOf(withTask(request, ReaderRequest::Task::Describe)).dump());
    return descriptionIn(reader.hear(job));
}

namespace {

/// The bytes of a box, x fastest, components as the layout has them: a reader writes them slab by slab, as they are
/// asked for.
class BoxBytes final : public ByteSource {
public:
    BoxBytes(Reader& reader, const ReaderLayout& answer, int level, const VoxelRegion& region, const std::string& path,
             const JobControl& job)
        : m_reader(reader), m_level(level), m_region(region), m_job{job.stop, {}} {
        const FileLayout& layout = answer.layout;
        const Int3 size = region.hi - region.lo;
        m_layerBytes = layerSize(size) * bytesPerVoxel(layout);
        m_componentBytes = m_layerBytes * static_cast<std::uint64_t>(size.z);
        m_components =
            componentsAreApart(layout) ? static_cast<std::uint64_t>(contentsOf(layout).components) : std::uint64_t{1};
        const auto layersIn = [&](std::uint64_t bytes) {
            return static_cast<int>(std::clamp<std::uint64_t>(bytes / m_layerBytes, 1, 1u << 30));
        };
        // Layers that are stored together are asked for together, where there is room.
        const int together = std::min(answer.layersAtOnce, layersIn(std::min(kMostSlab, availableMemoryBytes() / 4)));
        const int usual = layersIn(kSlab);
        m_layers = usual > together ? usual - usual % together : together;
        const std::uint64_t room = m_layerBytes * static_cast<std::uint64_t>(std::min(m_layers, size.z));
        requireMemory("reading it", path, room);
        reader.makeRoom(room);
        m_room = MappedFile::map(reader.voxels(), 0, room);
        if (!m_room)
            throw FileError("there is no memory for the voxels", path, "close other programs", Remedy::AllowMoreMemory);
    }

    std::size_t read(char* to, std::size_t count) override {
        std::size_t done = 0;
        while (done < count && m_at < m_components * m_componentBytes) {
            if (m_at < m_slabBegin || m_at >= m_slabEnd) readSlab();
            const std::size_t piece = std::min<std::size_t>(count - done, static_cast<std::size_t>(m_slabEnd - m_at));
            std::memcpy(to + done, m_room->data() + (m_at - m_slabBegin), piece);
            done += piece;
            m_at += piece;
        }
        return done;
    }
    bool skip(std::uint64_t count) override {
        const std::uint64_t left = m_components * m_componentBytes - m_at;
        m_at += std::min(count, left);
        return count <= left;
    }

private:
    /// Bytes of a slab, but for one layer that is larger, and for layers that are stored together. Memory that
    /// processes share is slow to get: a little that stays in a processor's cache, copied from, costs less than enough
    /// for all.
    static constexpr std::uint64_t kSlab = 1u << 20, kMostSlab = 256u << 20;

    /// The slab with the byte m_at; slabs begin where layers that are stored together do.
    void readSlab() {
        const auto component = m_at / m_componentBytes;
        const int z = m_region.lo.z + static_cast<int>(m_at % m_componentBytes / m_layerBytes);
        ReaderBox box{m_level, m_region, static_cast<int>(component)};
        box.region.lo.z = z;
        box.region.hi.z = std::min((z / m_layers + 1) * m_layers, m_region.hi.z);
        m_reader.read(box, m_job);
        m_slabBegin = component * m_componentBytes + static_cast<std::uint64_t>(z - m_region.lo.z) * m_layerBytes;
        m_slabEnd = m_slabBegin + static_cast<std::uint64_t>(box.region.hi.z - z) * m_layerBytes;
    }

    Reader& m_reader;
    const int m_level;
    const VoxelRegion m_region;
    const JobControl m_job;
    std::uint64_t m_layerBytes = 0, m_componentBytes = 0, m_components = 1;
    int m_layers = 1; ///< of a slab
    std::shared_ptr<const MappedFile> m_room;
    std::uint64_t m_at = 0, m_slabBegin = 0, m_slabEnd = 0; ///< the next byte; those in the room
};

/// Which voxels of which level make a volume.
struct LevelPlan {
    int level = 0;      ///< as ReaderBox has it
    VoxelRegion region; ///< in voxels of the level
    ExcerptPlan plan;   ///< of these
};

/// The coarsest level that is not coarser than what is wanted, and of whose voxels it can be made.
LevelPlan levelFor(const ExcerptPlan& wanted, const ReaderLayout& answer) {
    LevelPlan best{0, wanted.region, wanted};
    best.plan.region = {Int3(0), wanted.region.hi - wanted.region.lo};
    for (std::size_t n = 0; n < answer.levels.size(); ++n) {
        const ReaderLevel& level = answer.levels[n];
        if (wanted.factors % level.factors != Int3(0) || wanted.region.lo % level.factors != Int3(0)) continue;
        LevelPlan next{static_cast<int>(n) + 1, {}, wanted};
        next.region.lo = wanted.region.lo / level.factors;
        next.region.hi = glm::min((wanted.region.hi - 1) / level.factors + 1, level.dims); // its edge may be left out
        const Int3 size = next.region.hi - next.region.lo;
        if (glm::any(glm::lessThan(size, Int3(1)))) continue;
        next.plan.region = {Int3(0), size};
        next.plan.factors = wanted.factors / level.factors;
        next.plan.dims = (size - 1) / next.plan.factors + 1;
        best = std::move(next);
    }
    return best;
}

/// planExcerpt(); where files have coarser copies and nobody has said how fine it is to be, one of these that has room
/// and is enough for a first look.
ExcerptPlan planFor(const VolumeSource& source, const ReaderLayout& answer) {
    const FileContents contents = contentsOf(answer.layout);
    const ExcerptPlan plan = planExcerpt(source, contents.dims, contents.type, false);
    if (source.downsample != 0 || (!plan.excerpt.forMemory && voxelCount(plan.dims) <= kFirstLook)) return plan;
    ExcerptPlan chosen = plan;
    for (const ReaderLevel& level : answer.levels) {
        const int factor = std::max({level.factors.x, level.factors.y, level.factors.z});
        if (factor < plan.excerpt.factor) continue;
        chosen = planOf(plan.region, contents.dims, factor);
        chosen.excerpt.forMemory = plan.excerpt.forMemory;
        chosen.neededAtFull = plan.neededAtFull;
        chosen.available = plan.available;
        if (voxelCount(chosen.dims) <= kFirstLook) break;
    }
    return chosen;
}

/// Says what is read of a level, and where it lies.
void placeLevel(FileLayout& layout, const ReaderLayout& answer, const LevelPlan& taken) {
    std::size_t axis = layout.axes.front().components ? 1 : 0;
    const Int3 size = taken.region.hi - taken.region.lo;
    for (int a = 0; a < 3; ++a) layout.axes[axis++].size = size[a];
    if (taken.level > 0) {
        const ReaderLevel& level = answer.levels[static_cast<std::size_t>(taken.level - 1)];
        layout.spacing = level.spacing;
        layout.origin = level.origin;
        layout.notices.push_back("the voxels are those of a coarser copy in the file; a region, or all with a "
                                 "downsampling factor of 1, can be opened at full resolution");
    }
    layout.origin += layout.directions * (layout.spacing * Vec3(taken.region.lo));
    layout.plan = taken.plan;
}

/// Values that need no library to be read. The reader may be wrong, or in the hands of the file, but of this file
/// alone.
void placeInFile(FileLayout& layout, const std::vector<std::uint64_t>& starts) {
    const std::string& path = layout.dataPath;
    const std::uint64_t there = readableFileBytes(path), values = valuesIn(layout, path);
    if (values % starts.size() != 0) throw FileError("the voxels do not fill the parts of the file", path, kCopyAgain);
    for (const std::uint64_t start : starts) {
        if (start > there) throw FileError("some voxels lie behind the end of the file", path, kCopyAgain);
        requireStored(path, Encoding::Raw, values / starts.size(), bytesPerValue(layout.type), there - start,
                      kCopyAgain);
    }
    layout.start = starts.front();
    if (starts.size() == 1) return;
    for (const std::uint64_t start : starts) {
        layout.parts.push_back(layout);
        layout.parts.back().start = start;
    }
}

Volume readPart(const VolumeSource& source, const ReaderRequest& request, bool middleOnly, const JobControl& job) {
    Reader reader(request, job);
    reader.say(jsonOf(withTask(request, ReaderRequest::Task::Read)).dump());
    const ReaderLayout answer = layoutIn(reader.hear(job));
    FileLayout layout = answer.layout;
    layout.dataPath = source.path;
    VolumeSource taken = source;
    taken.step = 0; // the one that is read
    if (!taken.array.empty()) taken.array = layout.array;
    if (!taken.missing) taken.missing = answer.missing;
    const Int3 dims = dimsOf(answer, 0);
    if (middleOnly) taken.region = VoxelRegion{{0, 0, dims.z / 2}, {dims.x, dims.y, dims.z / 2 + 1}};
    if (!answer.inFile.empty()) {
        placeInFile(layout, answer.inFile);
        return readSamples(taken, layout, job);
    }
    const ExcerptPlan plan = planFor(taken, answer);
    static_cast<void>(bytesOf({0, {Int3(0), dims}, 0}, answer, source.path)); // throws where they are too many to count
    const LevelPlan level = levelFor(plan, answer);
    if (source.downsample == 0 && voxelCount(level.region.hi - level.region.lo) > kMostUnasked)
        throw FileError("reading its " + dimsText(level.region.hi - level.region.lo) + " voxels would take hours",
                        source.path, "open a region of them, or say how much coarser they are to be");
    placeLevel(layout, answer, level);
    layout.open = [&](const JobControl& reading) -> std::unique_ptr<ByteSource> {
        return std::make_unique<BoxBytes>(reader, answer, level.level, level.region, source.path, reading);
    };
    return readSamples(taken, layout, job);
}

} // namespace

Volume readInProcess(const VolumeSource& source, const ReaderRequest& request, const JobControl& job) {
    return readPart(source, request, false, job);
}

Volume readMiddleInProcess(const VolumeSource& source, const ReaderRequest& request, const JobControl& job) {
    return readPart(source, request, true, job);
}

} // namespace pellucid
