#include "base/file_watch.h"

#include <utility>

namespace pellucid {

namespace {

FileWatch& watch() {
    static FileWatch s_watch;
    return s_watch;
}

} // namespace

void watchFiles(FileWatch given) { watch() = std::move(given); }

void tellOfReading(const std::string& path) {
    if (watch().beforeReading) watch().beforeReading(path);
}
void tellOfWriting(const std::string& path) {
    if (watch().beforeWriting) watch().beforeWriting(path);
}

} // namespace pellucid
