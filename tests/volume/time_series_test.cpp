// Frames in memory: what the budget allows, what is known of them, and what happens with those that cannot be read.
#include <catch2/catch.hpp>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <latch>
#include <numeric>
#include <thread>

#include "support/temp_folder.h"
#include "volume/time_series.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

/// Names of `count` frames that nothing is behind.
SeriesListing listingOf(int count) {
    SeriesListing listing;
    listing.title = "frames";
    for (int f = 0; f < count; ++f) {
        SeriesFrame frame;
        frame.source.path = "frame " + std::to_string(f);
        frame.name = "step " + std::to_string(f);
        frame.time = f;
        listing.frames.push_back(frame);
    }
    return listing;
}

/// 10³ floats of frame, frame + 1, …: 4000 bytes, and 2000 of codes.
Volume ramp(int frame) {
    std::vector<float> values(1000);
    std::iota(values.begin(), values.end(), static_cast<float>(frame));
    return Volume({{10, 10, 10}}, std::move(values));
}
constexpr std::size_t kRampBytes = 6000;

/// A series of ramps that counts how often each is made.
struct Counted {
    std::shared_ptr<std::vector<int>> made;
    TimeSeries series;
    explicit Counted(int count)
        : made(std::make_shared<std::vector<int>>(count, 0)),
          series(listingOf(count), [made = made](int f, const JobControl&) {
              ++(*made)[static_cast<std::size_t>(f)];
              return ramp(f);
          }) {}
};

/// The largest number of bytes that this process has had in memory.
std::size_t peakBytes() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:") {
            std::size_t kib = 0;
            status >> kib;
            return kib * 1024;
        }
    return 0;
}

} // namespace

TEST_CASE("frames are forgotten that were not used for longest", "[time-series]") {
    Counted c(5);
    c.series.setBudget(3 * kRampBytes);
    for (const int f : {0, 1, 2, 0, 3}) c.series.load(f); // 1 goes
    CHECK(c.series.heldBytes() == 3 * kRampBytes);
    CHECK(c.series.roomFor() == 3);
    for (const int f : {0, 2, 3}) c.series.load(f);
    CHECK(*c.made == std::vector<int>{1, 1, 1, 1, 0});
    c.series.load(1);
    CHECK((*c.made)[1] == 2);
    c.series.setBudget(1); // one stays
    CHECK(c.series.heldBytes() == kRampBytes);
    c.series.load(1);
    CHECK((*c.made)[1] == 2);
    c.series.load(4);
    CHECK(c.series.heldBytes() == kRampBytes);
}

TEST_CASE("a frame that somebody holds stays, and counts", "[time-series]") {
    Counted c(4);
    c.series.setBudget(2 * kRampBytes);
    const auto held = c.series.load(0);
    for (const int f : {1, 2, 3}) {
        c.series.load(f);
        CHECK(c.series.heldBytes() == 2 * kRampBytes);
    }
    CHECK(c.series.load(0) == held);
    CHECK(*c.made == std::vector<int>{1, 1, 1, 1});
    // What is shown holds the frame, too, by its codes' volume as by itself.
    const ShownFrame shown = c.series.show(1, ValueRange{0, 500});
    CHECK(c.series.isShown(1, ValueRange{0, 500}));
    CHECK(shown.volume->range() == ValueRange{0, 500});
    CHECK(shown.histogram != nullptr);
    CHECK(shown.codes != nullptr);
}

TEST_CASE("the range of a series is that of all frames, found once and by frames that can be read", "[time-series]") {
    std::vector<int> made(6, 0);
    TimeSeries series(listingOf(6), [&](int f, const JobControl&) {
        ++made[static_cast<std::size_t>(f)];
        if (f == 2) throw FileError("it is damaged", "two.nrrd", "");
        return ramp(10 * f);
    });
    series.setBudget(2 * kRampBytes);
    CHECK_FALSE(series.isSurveyed());
    CHECK(series.range() == ValueRange{0, 1049}); // 50 … 50 + 999
    CHECK(series.isSurveyed());
    CHECK(series.heldBytes() <= 2 * kRampBytes);
    CHECK(made == std::vector<int>{1, 1, 1, 1, 1, 1});
    CHECK(series.summary(2).problem == "it is damaged, two.nrrd");
    CHECK(series.summary(3).range == ValueRange{30, 1029});
    CHECK(series.summary(3).validCount == 1000);
    CHECK(series.countsIn(2, {0, 1}, 4).empty());
    // Of 30, 31, … 1029 in bins of 0 … 1000: 220, 250, 250 and all the others, 280 with those beyond the end.
    const std::vector<double> counts = series.countsIn(3, {0, 1000}, 4);
    REQUIRE(counts.size() == 4);
    CHECK(counts[0] == Approx(220).margin(2));
    CHECK(counts[1] == Approx(250).margin(2));
    CHECK(counts[3] == Approx(280).margin(2));
    CHECK(std::accumulate(counts.begin(), counts.end(), 0.0) == Approx(1000));
    CHECK_THROWS_WITH(series.load(2), Contains("two.nrrd"));
    TimeSeries broken(listingOf(3), [](int f, const JobControl&) -> Volume {
        throw FileError("it is damaged", "f" + std::to_string(f), "copy it again");
    });
    CHECK_THROWS_WITH(broken.range(), Contains("f0")); // the first reason
}

TEST_CASE("a frame that comes back is sound again, one of another grid is refused", "[time-series]") {
    bool gone = true;
    TimeSeries series(listingOf(3), [&](int f, const JobControl&) {
        if (f == 1 && gone) throw FileError("no such file", "f1", "");
        if (f == 2) return Volume({{5, 10, 20}}, std::vector<float>(1000));
        return ramp(f);
    });
    CHECK_THROWS_AS(series.load(1), FileError);
    gone = false;
    CHECK(series.load(1)->value(0) == 1);
    CHECK(series.summary(1).problem.empty());
    CHECK(series.summary(1).validCount == 1000);
    CHECK_THROWS_WITH(series.load(2), Contains("5 x 10 x 20") && Contains("10 x 10 x 10") && Contains("frame 2"));
    CHECK(series.heldBytes() == kRampBytes);
}

TEST_CASE("frames in other units lie where the first one lies", "[time-series]") {
    TimeSeries series(listingOf(3), [](int f, const JobControl&) {
        Geometry g{{10, 10, 10}};
        g.lengthUnit = f == 0 ? LengthUnit::Micrometre : f == 1 ? LengthUnit::Nanometre : LengthUnit::Unknown;
        if (f == 1) g.spacing *= 1000;
        return Volume(g, std::vector<float>(1000, 1.0f));
    });
    const Geometry first = series.load(0)->geometry();
    CHECK(series.load(1)->geometry().spacing == first.spacing);
    CHECK(series.load(1)->geometry().lengthUnit == LengthUnit::Micrometre);
    CHECK(series.load(2)->geometry().spacing == first.spacing); // a unit is assumed for nobody
}

TEST_CASE("a frame tells which file is to blame where it is not the frame's own", "[time-series]") {
    const TempFolder folder;
    for (const char* name : {"a", "b", "c"})
        folder.write(std::string(name) + ".mhd", "NDims = 1\nDimSize = 2\nElementType = MET_UCHAR\nElementDataFile = " +
                                                     std::string(name) + ".raw\n");
    folder.write("a.raw", "12");
    folder.write("c.raw", "1"); // too short
    VolumeSource source;
    source.path = folder.path("*.mhd");
    const auto series = TimeSeries::open(source);
    series->survey({});
    CHECK(series->summary(0).problem.empty());
    CHECK(series->summary(1).problem == "the data file 'b.raw' that the header names is missing");
    CHECK(series->summary(2).problem == "the data has 1 of 2 bytes, " + folder.path("c.raw"));
}

TEST_CASE("many threads get the same frames within the budget", "[time-series]") {
    std::atomic<int> making = 0, most = 0, made = 0;
    TimeSeries series(listingOf(12), [&](int f, const JobControl&) {
        const int now = ++making;
        int before = most;
        while (now > before && !most.compare_exchange_weak(before, now)) continue;
        ++made;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --making;
        return ramp(f);
    });
    series.setBudget(3 * kRampBytes);
    std::atomic<int> wrong = 0;
    std::vector<std::thread> threads;
    std::latch begin(6);
    for (int t = 0; t < 6; ++t)
        threads.emplace_back([&, t] {
            begin.arrive_and_wait();
            for (int i = 0; i < 36; ++i) {
                const int f = (5 * i + t) % 12;
                if (series.load(f)->value(0) != f) ++wrong;
                if (i % 7 == 0 && series.show(f, ValueRange{0, 100}).data->value(1) != f + 1) ++wrong;
            }
        });
    for (std::thread& t : threads) t.join();
    CHECK(wrong == 0);
    CHECK(most <= 3); // not more at a time than there is room for
    CHECK(made >= 12);
    series.setBudget(3 * kRampBytes);
    CHECK(series.heldBytes() <= 3 * kRampBytes);
}

TEST_CASE("who waits for a frame can be stopped", "[time-series]") {
    std::latch begun(1), go(1);
    TimeSeries series(listingOf(2), [&](int f, const JobControl&) {
        begun.count_down();
        go.wait();
        return ramp(f);
    });
    std::thread reader([&] { series.load(0); });
    begun.wait();
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(series.load(0, {stop.get_token(), {}}), Cancelled);
    go.count_down();
    reader.join();
    CHECK(series.load(0)->value(0) == 0);
}

TEST_CASE("a hundred frames of 128³ floats play within 256 MiB, with one gone and one cut off", "[time-series]") {
    // 8 MiB of floats and 4 MiB of codes a frame: 1200 MiB in all, 20 frames at a time. The files are sparse: of each
    // nothing is written but a value at its beginning, so that their range is 0 … 1 + frame.
    const TempFolder folder;
    constexpr int kFrames = 100, kGone = 41, kCutOff = 57;
    constexpr std::size_t kFrameFile = 128 * 128 * 128 * sizeof(float), kBudget = std::size_t{256} << 20;
    const auto name = [&](int f) { return "d_" + std::string(f < 10 ? "0" : "") + std::to_string(f) + ".raw"; };
    for (int f = 0; f < kFrames; ++f) {
        if (f == kGone) continue;
        folder.write(name(f), bytesOf(std::vector<float>{1.0f + static_cast<float>(f)}));
        std::filesystem::resize_file(folder.path(name(f)), f == kCutOff ? kFrameFile / 2 : kFrameFile);
    }
    VolumeSource source;
    source.path = folder.path("d_%02d.raw");
    source.raw = parseRawLayout("128,128,128,f32");
    const auto series = TimeSeries::open(source);
    REQUIRE(series->size() == kFrames);
    series->setBudget(kBudget);
    const std::size_t before = peakBytes();
    std::size_t mostHeld = 0;
    CHECK(series->range() == ValueRange{0, kFrames});
    CHECK(series->heldBytes() <= kBudget);
    int refused = 0;
    for (int round = 0; round < 2; ++round)
        for (int f = 0; f < kFrames; ++f) {
            try {
                const ShownFrame shown = series->show(f, std::nullopt);
                if (shown.data->value(0) != f + 1) FAIL_CHECK("frame " << f << " is another one");
            } catch (const FileError& e) {
                ++refused;
                CHECK((f == kGone || f == kCutOff));
                CHECK_THAT(e.what(), Contains(name(f)));
                CHECK_THAT(e.what(), Contains(f == kGone ? "no such file" : "4194304 bytes"));
            }
            mostHeld = std::max(mostHeld, series->heldBytes());
            if (series->heldBytes() > kBudget) FAIL_CHECK("at frame " << f << " too much is held");
        }
    CHECK(refused == 4);
    CHECK(mostHeld > kBudget - 2 * (kFrameFile * 3 / 2)); // the budget is made use of
    const std::size_t grown = peakBytes() - before;
    INFO("held " << mostHeld / 1048576.0 << " MiB, the process grew by " << grown / 1048576.0 << " MiB");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // which keep memory of their own
    CHECK(grown <= kBudget);
#endif
    for (const int f : {kGone, kCutOff}) CHECK(!series->summary(f).problem.empty());
}
