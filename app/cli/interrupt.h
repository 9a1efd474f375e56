// Ctrl-C: work is asked to stop, and where it does not within a moment the process ends by itself.
#pragma once

#include <stop_token>

namespace pellucid::cli {

/// Takes over SIGINT and SIGTERM. Call it before any thread is started, since threads inherit what it blocks.
void installInterrupt();

/// Asked to stop when one of the two signals has come.
std::stop_token interruptToken();

/// The exit status that belongs to the signal that came: 130 (SIGINT), 143 (SIGTERM); 0 where none came.
int interruptStatus();

} // namespace pellucid::cli
