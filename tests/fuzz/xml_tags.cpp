// Tags of XML files.
#include "volume/formats/xml_tags.h"
#include "fuzz_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".xml", [&](const std::string& path) {
        succeeds([&] {
            const JobControl job;
            XmlTags tags(path, job);
            std::uint64_t end = 0;
            for (XmlTag tag; tags.next(tag); end = tag.end) {
                require(tag.opens || tag.closes, "a tag opens or closes");
                require(tag.end > end && tag.end <= size, "tags follow each other in the file");
            }
        });
    });
    return 0;
}
