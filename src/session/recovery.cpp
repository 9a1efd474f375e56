#include "session/recovery.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <filesystem>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_file.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSuffix = ".recovery.pellucid.json";
constexpr const char* kLockSuffix = ".lock";
constexpr const char* kTitleKey = "title";

std::string localTime(std::time_t time) {
    std::tm parts{};
    localtime_r(&time, &parts);
    char text[32] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &parts);
    return text;
}

/// Whether a living process holds the lock of a recovery file.
bool isOwned(const std::string& path) {
    const int lock = ::open((path + kLockSuffix).c_str(), O_RDWR | O_CLOEXEC);
    if (lock < 0) return false;
    const bool owned = ::flock(lock, LOCK_EX | LOCK_NB) != 0;
    ::close(lock);
    return owned;
}

} // namespace

RecoveryFile::RecoveryFile(const std::string& folder) {
    std::error_code ec;
    fs::create_directories(folder, ec);
    if (!fs::is_directory(folder, ec))
        throw FileError("cannot make the folder for recovery files", folder, "check permissions and space");
    static std::atomic<unsigned> s_count = 0;
    const std::string name = std::to_string(::getpid()) + "-" + std::to_string(std::time(nullptr)) + "-" +
                             std::to_string(s_count++) + kSuffix;
    m_path = (fs::path(folder) / name).string();
    m_lockPath = m_path + kLockSuffix;
    m_lock = ::open(m_lockPath.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (m_lock >= 0 && ::flock(m_lock, LOCK_EX | LOCK_NB) == 0) return;
    if (m_lock >= 0) ::close(m_lock);
    throw FileError("cannot keep unsaved work", m_lockPath, "check permissions and space");
}

RecoveryFile::~RecoveryFile() {
    remove();
    ::unlink(m_lockPath.c_str());
    if (m_lock >= 0) ::close(m_lock);
}

void RecoveryFile::write(const Session& session, const std::string& title) const {
    nlohmann::json document = jsonFromSession(session, "", DataPaths::Absolute);
    document[kTitleKey] = title;
    writeTextAtomically(m_path, document.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void RecoveryFile::remove() const {
    std::error_code ec;
    fs::remove(m_path, ec);
}

std::vector<Recovered> recoverableSessions(const std::string& folder) {
    std::vector<std::pair<std::time_t, Recovered>> found;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(folder, ec)) {
        const std::string path = entry.path().string();
        if (!path.ends_with(kSuffix) || isOwned(path)) continue;
        struct stat status {};
        if (::stat(path.c_str(), &status) != 0) continue;
        try {
            const nlohmann::json document = readJson(path);
            const auto title = document.find(kTitleKey);
            found.push_back({status.st_mtime,
                             {path, title != document.end() && title->is_string() ? title->get<std::string>() : "",
                              localTime(status.st_mtime)}});
        } catch (const Error&) {
            // Damaged: nothing to offer.
        }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Recovered> all;
    for (auto& [time, recovered] : found) all.push_back(std::move(recovered));
    return all;
}

void discardRecovered(const std::string& path) {
    std::error_code ec;
    fs::remove(path, ec);
    fs::remove(path + kLockSuffix, ec);
}

} // namespace pellucid
