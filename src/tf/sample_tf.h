// The transfer function a volume opens with.
#pragma once

#include "tf/transfer_function.h"

namespace pellucid {

/// A built-in sample's own (`disks`: light green, magenta, dark green, fig. 4.1), else tents:3.
TransferFunction defaultTf(const Volume& volume);

} // namespace pellucid
