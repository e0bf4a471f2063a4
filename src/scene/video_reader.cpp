#include "scene/preset_fields.hpp"

namespace doppel {
namespace {

/// Sizes that the pixel format allows.
void check_size(const TomlReader& table, const VideoSpec& video) {
    if (!video.is_encoded() || video.pixel_format == PixelFormat::yuv444) return;
    const auto even = [](int pixels) { return pixels + pixels % 2; };
    if (video.size.width % 2 != 0 || video.size.height % 2 != 0)
        throw table.fault("size", "must be even, as {} needs it in {}; it is [{}, {}]; [{}, {}] would do",
                          video.format == FilmFormat::mp4 ? "H.264" : "WebM", name_of(video.pixel_format),
                          video.size.width, video.size.height, even(video.size.width), even(video.size.height));
}

void check_transparent(const TomlReader& table, const VideoSpec& video) {
    const bool has_alpha =
        video.format == FilmFormat::png || video.format == FilmFormat::apng ||
        (video.format == FilmFormat::webm && video.codec != "av1" && video.pixel_format == PixelFormat::yuv420);
    if (video.transparent && !has_alpha)
        throw table.fault("transparent",
                          "takes a format with opacity: png, apng, or webm (VP9, yuv420p); the format is \"{}\"",
                          name_of(video.format));
}

void check_layout(TomlReader& table, VideoSpec& video) {
    const bool is_portrait = video.layout == Arrangement::portrait;
    if (is_portrait && !table.has("size")) video.size = {1080, 1920};
    if (is_portrait && video.size.height < video.size.width)
        throw table.fault("size", "must be higher than wide for the layout \"portrait\"; it is [{}, {}]",
                          video.size.width, video.size.height);
    if (!video.pendulums && video.layout != Arrangement::side_by_side && !is_portrait)
        throw table.fault("panels", "must hold \"pendulums\" for the layout \"{}\"", name_of(video.layout));
}

/// Members of an ensemble leave no trails.
void read_style(TomlReader& table, VideoSpec& video) {
    const bool is_ensemble = video.layout == Arrangement::ensemble;
    if (is_ensemble) video.trail_s = 0;
    style_fields(table, video);
    for (const auto& [key, value] : {std::pair{"trail_s", video.trail_s}, {"glow_px", video.glow_px.value_or(0)}})
        if (is_ensemble && value > 0)
            throw table.fault(key, "must be 0 for the layout \"ensemble\", whose members leave no trails; it is {}",
                              value);
}

}  // namespace

void read_picture_size(TomlReader& table, Size& into) {
    table.read(size_field, into);
}

void read_theme(TomlReader& table, std::string& into) {
    theme_field(table, into);
}

void read_video(TomlReader& table, VideoSpec& video) {
    read_picture_size(table, video.size);
    format_fields(table, video);
    check_transparent(table, video);
    time_fields(table, video);
    layout_fields(table, video);
    check_layout(table, video);
    check_size(table, video);
    read_style(table, video);
    table.finish();
}

}  // namespace doppel
