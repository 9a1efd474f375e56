// What each shell reads to complete command lines: a frame, which is a file beside this one, and tables in its
// language.
#pragma once

#include <string>
#include <vector>

#include "completions/completion_words.h"

namespace pellucid::cli {

/// A file of this folder, compiled in: what is the same whatever the options are. "@TABLES@" stands for the rest.
struct CompletionFrame {
    const char* name; ///< of the file: "frame.bash"
    const char* text;
};
const std::vector<CompletionFrame>& completionFrames();

/// "bash", "fish", "zsh".
std::vector<std::string> completionShells();
/// The script; throws UsageError for a shell that is none of these.
std::string completionScript(const std::string& shell, const CompletionCommand& program);

} // namespace pellucid::cli
