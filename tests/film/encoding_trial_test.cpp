// Encoding of recorded frames, compared pixel by pixel with a film that is written and read back.
#include "bench/encoders/encoding_trial.hpp"

#include "output/decoded.hpp"
#include "output/fixtures.hpp"

#include <cmath>

namespace doppel::encoding_trial_test {

using namespace test;

constexpr Size size{480, 270 - 270 % 16};
constexpr long count = 40;

RecordedFrames recorded() {
    RecordedFrames frames{size, {}};
    for (long k = 0; k < count; ++k)
        convert(moving_scene(size, k), whole(size), AV_PIX_FMT_YUV420P, frames.frames.emplace_back());
    return frames;
}

/// Luma of a recorded frame that was stored whole.
const std::uint8_t* luma(const RecordedFrames& frames, long k) {
    return frames.frames[static_cast<std::size_t>(k)].bytes.data();
}

TEST(EncodingTrial, FindsTheNoiseOfAFileThatHoldsTheSame) {
    const auto frames = recorded();
    for (const char* preset : {"doppel", "veryfast"}) {
        const VideoOptions options{.size = size, .preset = preset};
        double sum = 0;
        const auto path = film(fresh_folder() / "x.mp4", options, count);
        const auto video = read_video(path, [&](const Luma& decoded) {
            for (std::size_t i = 0; i < decoded.y.size(); ++i)
                sum += std::pow(decoded.y[i] - luma(frames, decoded.frame)[i], 2);
        });
        ASSERT_EQ(video.times.size(), static_cast<std::size_t>(count));
        const double pixels = double(count) * size.width * size.height;
        const auto trial = try_encoding(frames, options);
        EXPECT_NEAR(trial.whole.psnr_db, 10 * std::log10(255 * 255 * pixels / sum), 1e-9) << preset;
        EXPECT_LT(trial.bytes, std::filesystem::file_size(path)) << preset;  // the file also has a container
        EXPECT_GT(trial.bytes, std::filesystem::file_size(path) / 2) << preset;
        EXPECT_GT(trial.cpu_s, 0);
        EXPECT_EQ(time_encoding(frames, options).bytes, trial.bytes);
        EXPECT_GT(trial.first_bytes, trial.bytes / static_cast<std::size_t>(count)) << "a whole frame";
        EXPECT_LT(trial.first_bytes, trial.bytes);
    }
}

}  // namespace doppel::encoding_trial_test
