#pragma once

#include "output/sink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace doppel {

/// The parameters of an encoder besides the quality: a preset, and its changes.
struct EncoderSetting {
    std::string_view codec, name, preset;
    std::string_view changes = {};  // "key=value key=value", of libav; {} stands for crf
};

// The first setting of a codec is the reference for the others.
inline constexpr std::array encoder_settings{
    EncoderSetting{"h264", "veryfast", "veryfast"},
    EncoderSetting{"h264", "doppel", "doppel"},
    EncoderSetting{"h264", "ultrafast", "ultrafast"},
    EncoderSetting{"h264", "superfast", "superfast"},
    EncoderSetting{"h264", "faster", "faster"},
    EncoderSetting{"h264", "doppel: no B-frames", "doppel", "x264-params=bframes=0"},
    EncoderSetting{"h264", "doppel: finer B-frames", "doppel", "x264-params=pbratio=2"},
    EncoderSetting{"h264", "doppel: coarser B-frames", "doppel", "x264-params=pbratio=3"},
    EncoderSetting{"h264", "doppel: the usual dead zone", "doppel", "x264-params=deadzone-inter=21"},
    EncoderSetting{"h264", "doppel: no parts of 4×4", "doppel", "x264-params=partitions=i8x8,i4x4,p8x8,b8x8"},
    EncoderSetting{"h264", "doppel: two references", "doppel", "x264-params=ref=2"},
    EncoderSetting{"h264", "doppel: B-frames as references", "doppel", "x264-params=b-pyramid=normal"},
    EncoderSetting{"h264", "doppel: frames in threads", "doppel", "threads=8 x264-params=sliced-threads=0"},
    EncoderSetting{"h264", "doppel: motion to whole pixels", "doppel", "x264-params=subme=0"},
    EncoderSetting{"h264", "doppel: no deblocking", "doppel", "x264-params=no-deblock=1"},
    EncoderSetting{"h264", "doppel: adaptive quantizers", "doppel", "x264-params=crf={}:aq-mode=1"},
    EncoderSetting{"vp9", "veryfast", "veryfast"},
    EncoderSetting{"vp9", "doppel", "doppel"},
    EncoderSetting{"vp9", "ultrafast", "ultrafast"},
    EncoderSetting{"vp9", "doppel: slower", "doppel", "cpu-used=4"},
    EncoderSetting{"vp9", "doppel: faster", "doppel", "cpu-used=8"},
    EncoderSetting{"vp9", "doppel: not for screens", "doppel", "tune-content=default"},
    EncoderSetting{"vp9", "doppel: no look ahead", "doppel", "lag-in-frames=0"},
    EncoderSetting{"av1", "veryfast", "veryfast"},
    EncoderSetting{"av1", "doppel", "doppel"},
    EncoderSetting{"av1", "ultrafast", "ultrafast"},
    EncoderSetting{"av1", "faster", "faster"},
    EncoderSetting{"av1", "for screens", "veryfast", "svtav1-params=lp=8:scm=1"},
    EncoderSetting{"av1", "low delay", "veryfast", "svtav1-params=lp=8:pred-struct=1"},
};

/// Whether it differs from the default in one option only.
inline bool is_variation(const EncoderSetting& setting) {
    return setting.preset == "doppel" && !setting.changes.empty();
}

/// In libav's form.
inline Metadata changes_of(const EncoderSetting& setting, int crf) {
    Metadata all;
    const auto text = fmt::format(fmt::runtime(setting.changes), crf);
    for (std::string_view rest = text; !rest.empty();) {
        const auto one = rest.substr(0, rest.find(' '));
        rest.remove_prefix(std::min(one.size() + 1, rest.size()));
        const auto equals = one.find('=');
        all.emplace_back(one.substr(0, equals), one.substr(equals + 1));
    }
    return all;
}

inline constexpr auto encoder_codecs = std::to_array<std::string_view>({"h264", "vp9", "av1"});

}  // namespace doppel
