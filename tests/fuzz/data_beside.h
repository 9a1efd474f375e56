// Data files for headers that name some: 24 values of a byte, in each way in which they may be stored.
#pragma once

#include "fuzz_input.h"
#include "volume/packers.h"
#include "volume/volume_files.h"

namespace pellucid::fuzz {

inline const std::string kDataBeside = "abcdefghijklmnopqrstuvwx";

struct DataBeside : InputFolder {
    DataBeside() {
        keep("d.raw", kDataBeside);
        keep("d.gz", test::gzipped(kDataBeside));
        keep("d.zz", test::zlibbed(kDataBeside));
        keep("d.bz2", test::bzipped(kDataBeside));
        keep("d.txt", "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24\n");
        for (int i = 0; i < 4; ++i) keep("s" + std::to_string(i) + ".raw", kDataBeside.substr(6 * i, 6));
    }
};

} // namespace pellucid::fuzz
