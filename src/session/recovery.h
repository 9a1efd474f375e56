// Sessions that survive a crash: where unsaved work is kept, and who owns it.
#pragma once

#include <string>
#include <vector>

#include "session/session_json.h"

namespace pellucid {

/// The file that one window keeps its unsaved work in. Its name tells the process: as long as that lives, nobody else
/// offers the file; a lock, which the system lets go of whatever way the process ends, says whether it does.
class RecoveryFile {
public:
    /// In `folder`, which is made where it is missing. Throws FileError where that cannot be.
    explicit RecoveryFile(const std::string& folder);
    ~RecoveryFile(); ///< removes the file: who ends in order has saved what is wanted
    RecoveryFile(const RecoveryFile&) = delete;
    RecoveryFile& operator=(const RecoveryFile&) = delete;

    const std::string& path() const { return m_path; }
    /// Any thread may call. `title` is how a later start names it.
    void write(const Session& session, const std::string& title) const;
    void remove() const; ///< what it holds has been saved, or is not wanted

private:
    std::string m_path, m_lockPath;
    int m_lock = -1;
};

/// Work that a process left behind which has ended.
struct Recovered {
    std::string path;  ///< of the recovery file
    std::string title; ///< of the data
    std::string when;  ///< local time of its last change, "2031-05-07 14:03"
};
/// The latest first. Files that cannot be read are left out, and left there.
std::vector<Recovered> recoverableSessions(const std::string& folder);
/// Removes what was restored or is not wanted.
void discardRecovered(const std::string& path);

} // namespace pellucid
