// The bytes that a bzip2 stream unpacks to.
#pragma once

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "volume/formats/byte_source.h"

namespace pellucid {

/// The unpacked bytes of the bzip2 stream at byte `start` of a file, also of several streams one after the other. Bytes
/// may be damaged until the stream that holds them has ended: see soundBytes().
class Bunzipped final : public UnpackedBytes {
public:
    Bunzipped(const std::string& path, std::uint64_t start, const JobControl& job);
    ~Bunzipped() override;
    std::size_t read(char* to, std::size_t count) override;
    std::uint64_t decoded() const override { return m_decoded; }
    std::uint64_t soundBytes() const override { return m_sound; }
    End end() const override { return m_end; }

private:
    struct Stream; // of libbz2
    bool fill();
    bool beginNext();
    std::ifstream m_in;
    const JobControl& m_job;
    std::unique_ptr<Stream> m_stream;
    std::vector<char> m_packed;
    bool m_streamEnded = false;
    std::uint64_t m_decoded = 0, m_sound = 0;
    End m_end = End::None;
};

} // namespace pellucid
