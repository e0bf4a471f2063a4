// The sink writes what the reader accepts; the reader rejects what the sink rejects.
#include "output/fixtures.hpp"
#include "output/sink.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string_view>

namespace doppel::format_edges_test {

struct Edge {
    Size size;
    const char* rate;
    std::set<std::string_view> refused_by = {};
};

Preset read(const FormatRow& row, const Edge& edge) {
    const auto two_samples = quotient({2, 1}, *parse_rational(edge.rate))->text();
    return read_preset(
        {"x", "x.toml",
         fmt::format("[scene]\nsample_hz = \"{}\"\nduration_s = \"{}\"\n[system]\nintegrator = \"taylor\"\n[video]\n"
                     "format = \"{}\"\nsize = [{}, {}]\nfps = \"{}\"\n{}",
                     edge.rate, two_samples, name_of(row.format), edge.size.width, edge.size.height, edge.rate,
                     row.format == FilmFormat::webm ? fmt::format("codec = \"{}\"\n", row.codec) : "")});
}

TEST(FormatEdges, WhatTheReaderTakesTheSinkWrites) {
    const std::array edges{
        Edge{{64, 64}, "25"},
        Edge{{65, 64}, "25", {"H.264", "VP9", "AV1", "Y4M"}},
        Edge{{16384, 64}, "25"},
        Edge{{64, 16384}, "25"},
        Edge{{16384, 16384}, "25", {"H.264", "VP9", "AV1", "GIF", "animated PNG", "Y4M", "raw RGB"}},
        Edge{{64, 64}, "1"},
        Edge{{64, 64}, "1/655", {"AV1"}},
        Edge{{64, 64}, "1/656", {"AV1", "GIF"}},
        Edge{{64, 64}, "50"},
        Edge{{64, 64}, "51", {"GIF"}},
        Edge{{64, 64}, "240", {"GIF"}},
        Edge{{64, 64}, "241", {"GIF"}},  // more than SVT-AV1 accepts
        Edge{{64, 64}, "1000", {"GIF"}},
        Edge{{64, 64}, "65537/66", {"GIF", "animated PNG"}},
    };
    const auto folder = test::fresh_folder();
    for (const auto& row : film_formats)
        for (const auto& edge : edges) {
            const bool is_refused = edge.refused_by.contains(row.title);
            const auto [code, message] = error_of([&] { read(row, edge); });
            EXPECT_EQ(message == "no error", !is_refused) << row.title << " " << edge.size.width << "x"
                                                          << edge.size.height << " " << edge.rate << ": " << message;
            if (is_refused || row.format == FilmFormat::png || row.format == FilmFormat::html) continue;
            const auto rate = *parse_rational(edge.rate);
            const VideoOptions options{.format = row.format,
                                       .codec = std::string(row.codec),
                                       .size = edge.size,
                                       .fps_numerator = rate.numerator,
                                       .fps_denominator = rate.denominator};
            const auto write = [&] {
                const auto sink = make_video_sink(folder / "x", options);
                for (int k = 0; k < 2; ++k) sink->take(Picture(edge.size), {{0, 0, edge.size.width, edge.size.height}});
                sink->finish();
            };
            const auto written = error_of(write);
            EXPECT_EQ(written.second, "no error") << row.title << " " << edge.size.width << "x" << edge.size.height
                                                  << " " << edge.rate << ": " << written.second;
        }
}

}  // namespace doppel::format_edges_test
