#include "output_files.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_watch.h"
#include "output.h"
#include "ranks/process_ranks.h"

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

/// What a file is known by, beside its name: where the name leads, and its number on the disk.
struct Identity {
    std::string place;                                  ///< empty: no file that counts
    std::optional<std::pair<dev_t, ino_t>> onDisk = {}; ///< of a file that is there
};

Identity identityOf(const std::string& path) {
    std::error_code ec;
    const fs::path target = behindLinks(path);
    struct stat status {};
    Identity identity;
    if (stat(target.c_str(), &status) == 0) {
        if (!S_ISREG(status.st_mode)) return {};
        identity.onDisk.emplace(status.st_dev, status.st_ino);
    }
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    identity.place = (fs::weakly_canonical(fs::absolute(folder, ec), ec) / target.filename()).string();
    return ec ? Identity{} : identity;
}

/// Files with what is known of each.
template <class What>
class FileSet {
public:
    const What* find(const Identity& file) const {
        if (const auto found = m_byPlace.find(file.place); found != m_byPlace.end()) return &found->second;
        if (!file.onDisk) return nullptr;
        const auto found = m_onDisk.find(*file.onDisk);
        return found == m_onDisk.end() ? nullptr : &m_byPlace.at(found->second);
    }
    void add(const Identity& file, What what) {
        m_byPlace.emplace(file.place, std::move(what));
        if (file.onDisk) m_onDisk.emplace(*file.onDisk, file.place);
    }
    /// What was there gives way to a new file, and its number may become another one's.
    void forgetOnDisk(const std::string& place) {
        std::erase_if(m_onDisk, [&](const auto& entry) { return entry.second == place; });
    }

private:
    std::map<std::string, What> m_byPlace;
    std::map<std::pair<dev_t, ino_t>, std::string> m_onDisk;
};

class CallFiles {
public:
    void addInput(const std::string& path) {
        const Identity file = identityOf(path);
        if (!file.onDisk) return; // what is not there cannot be harmed
        const std::lock_guard lock(m_mutex);
        if (m_inputs.find(file) != nullptr) return;
        if (const Output* output = m_outputs.find(file); output != nullptr && !m_written.contains(file.place))
            throw overwrites(output->path, path);
        m_inputs.add(file, path);
    }

    void addOutput(const std::string& path, const std::string& option) {
        const Identity file = identityOf(path);
        if (file.place.empty()) return;
        const std::lock_guard lock(m_mutex);
        add(file, {path, option});
    }

    /// Unannounced ones too. Each is written once.
    void write(const std::string& path) {
        const Identity file = identityOf(path);
        if (file.place.empty()) return;
        const std::lock_guard lock(m_mutex);
        const Output* known = m_outputs.find(file);
        if (known == nullptr)
            add(file, {path, ""});
        else if (m_written.contains(file.place))
            throw sameFile(*known, {path, ""});
        m_written.insert(file.place);
        m_outputs.forgetOnDisk(file.place);
    }

private:
    struct Output {
        std::string path, option;
        std::string text() const { return option.empty() ? path : option + " " + path; }
    };

    static UsageError overwrites(const std::string& output, const std::string& input) {
        return {"the output would overwrite the input", output == input ? output : output + ", which is " + input,
                "choose another name"};
    }
    static UsageError sameFile(const Output& a, const Output& b) {
        return {"two outputs would be the same file", a.text() + " and " + b.text(), "choose another name for one"};
    }

    void add(const Identity& file, const Output& output) {
        if (const std::string* input = m_inputs.find(file)) throw overwrites(output.path, *input);
        if (const Output* other = m_outputs.find(file)) throw sameFile(*other, output);
        m_outputs.add(file, output);
    }

    std::mutex m_mutex;
    FileSet<std::string> m_inputs; ///< the names that they were given
    FileSet<Output> m_outputs;
    std::set<std::string> m_written; ///< places
};

CallFiles& callFiles() {
    static CallFiles s_files;
    return s_files;
}

} // namespace

void watchCallFiles() {
    watchFiles({[](const std::string& path) { callFiles().addInput(path); },
                [](const std::string& path) { callFiles().write(path); }});
}

void addInputFile(const std::string& path) { callFiles().addInput(path); }

void addOutputFile(const std::string& path, const std::string& option) {
    requireWritable(path);
    callFiles().addOutput(path, option);
}

void addOutputFile(const std::string& folder, const std::string& file, const std::string& option) {
    const std::string path = (fs::path(folder) / file).string();
    std::error_code ec;
    if (fs::is_directory(folder, ec)) requireWritable(path); // else it is made for them
    callFiles().addOutput(path, option);
}

std::string parseOutputFolder(const std::string& path, const std::string& option) {
    if (path.empty()) throw UsageError("the folder name is empty", option, "name the folder to write to");
    std::error_code ec;
    if (fs::is_directory(path, ec)) return path;
    const fs::path folder = fs::path(path).has_filename() ? fs::path(path) : fs::path(path).parent_path();
    if (fs::exists(fs::symlink_status(folder, ec))) // a link that leads nowhere too
        throw FileError("a file has the folder's name", path, "choose another name");
    requireWritable(folder.string());
    return path;
}

OutputFolder::OutputFolder(const std::string& path) : m_path(path) {
    std::error_code ec;
    m_isNew = std::filesystem::create_directory(path, ec);
    if (ec && !std::filesystem::is_directory(path))
        throw FileError("cannot create the folder (" + ec.message() + ")", path, "check permissions and space");
    Communicator* const ranks = ranksOfProcess();
    if (ranks == nullptr) return;
    try {
        for (const bool madeByRank : gatherValues(*ranks, m_isNew)) m_isNew |= madeByRank;
    } catch (...) {
        if (m_isNew) std::filesystem::remove(path, ec);
        throw;
    }
}

void writeCamera(const Camera& camera, const std::string& path) {
    writeTextAtomically(path, jsonText(Json(jsonFromCamera(camera))) + "\n");
}

} // namespace pellucid::cli
