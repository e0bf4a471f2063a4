#include "figure/encoder_quality.hpp"
#include "figure/encoder_settings.hpp"
#include "figure/kinds.hpp"
#include "film/film.hpp"
#include "output/encoding_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace doppel {
namespace {

/// crf at which each is tried: the one compared with in the middle.
constexpr std::array qualities{15, 18, 21};

/// A film to be encoded.
struct FilmToEncode {
    std::string name;
    Scene scene;
};

/// How often a frame is whole: as in "doppel" and nearly so in x264's presets, s.
constexpr double key_interval_s = 5;

/// Bytes a frame of a long film: of what was encoded only the first frame is whole.
double bytes_per_frame(const EncodingCost& cost, std::size_t frames, double fps) {
    const double whole = 1 / (key_interval_s * fps);
    const auto first = static_cast<double>(cost.first_bytes), others = static_cast<double>(cost.bytes) - first;
    return whole * first + (1 - whole) * others / static_cast<double>(frames - 1);
}

/// Makes room for a value and a margin on an axis that is logarithmic.
void widen(PlotAxis& axis, double value) {
    constexpr double margin = 1.4;
    if (!std::isfinite(value)) return;
    axis.low = std::min(axis.low.value_or(value), value / margin);
    axis.high = std::max(axis.high.value_or(value), value * margin);
}

/// Of what differs nowhere: a number yet, more than any difference has.
double finite(double psnr_db) {
    return std::min(psnr_db, 100.0);
}

/// What encoders take for films at the same quality. A trial is a setting on a film: the first time with what comes of
/// it, then, in turn with the others, `repeats` − 1 times for its CPU time alone.
class Encoders final : public Experiment {
public:
    static constexpr std::string_view table_key = "encoders";
    Encoders() = default;
    explicit Encoders(FigureReader& reader) {
        auto table = reader.settings(*this);
        settings_ = table.finish();
        for (const auto& setting : encoder_settings)
            if (setting.codec == codec_) tried_.push_back(&setting);
        auto entries = reader.entries("film");
        if (entries.empty()) throw reader.top.fault("film", "is missing: a [[film]] each names what is encoded");
        for (auto& entry : entries) add_film(entry);
        recordings_ = std::make_unique<Recording[]>(films_.size());
    }

    template <class Visit>
    void fields(Visit& visit) {
        visit({.key = "codec", .help = "of the encoder", .names = encoder_codecs}, codec_);
        visit({"from_s", "of the film, where the frames begin", "s", not_negative}, from_s_);
        visit({"frames", "of each film", "", from_to(2, 100'000)}, frames_);
        visit({"repeats", "of each encoding, in turn with the others; the least CPU time counts", "", from_to(1, 100)},
              repeats_);
    }
    static FieldTable other_table() {
        FieldTable film{"[[film]]", "A film each.\n"};
        VideoSpec video;
        std::string name;
        film_fields(film, name, video);
        return film;
    }

    static void read_others(FigureReader& reader) {
        for (auto& entry : reader.entries("film")) {
            std::string name;
            VideoSpec video;
            film_fields(entry, name, video);
            entry.finish();
        }
    }

    std::size_t trials() const override { return films_.size() * trials_of_film(); }
    bool measures_time() const override { return true; }
    std::string unit() const override { return "settings"; }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        return is_first(trial) ? numbers.size() == qualities.size() * numbers_in<EncodedRow> && finite_or_none(numbers)
                               : numbers.size() == qualities.size() && all_finite(numbers);
    }

    std::vector<std::string> columns() const override {
        return {"film",
                "width_px",
                "height_px",
                "theme",
                "setting",
                "crf",
                "cpu_ms_per_frame",
                "bytes_per_frame",
                "psnr_db",
                "moving_psnr_db",
                "ssim",
                "moving_ssim",
                "cpu_at_equal_quality",
                "bytes_at_equal_quality"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t f = 0; f < films_.size(); ++f) {
            const auto& video = films_[f].scene.preset.video;
            for (std::size_t s = 0; s < tried_.size(); ++s) {
                const auto [bytes, cpu] = equal(numbers, f, s);
                for (const auto& row : rows(numbers, f, s))
                    add_row(table, films_[f].name, video.size.width, video.size.height, video.theme, tried_[s]->name,
                            static_cast<int>(row.crf), row.cpu_ms, row.bytes, row.psnr_db, row.moving_psnr_db, row.ssim,
                            row.moving_ssim, cpu, bytes);
            }
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        PlotAxis x{.label = fmt::format("bytes, {} = 1", tried_[0]->name), .logarithmic = true};
        PlotAxis y{.label = fmt::format("CPU time, {} = 1", tried_[0]->name), .logarithmic = true};
        for (std::size_t f = 0; f < films_.size(); ++f) {
            const auto& video = films_[f].scene.preset.video;
            Plot plot;
            plot.title = fmt::format("{}, {}×{}, {}", films_[f].name, video.size.width, video.size.height, video.theme);
            Curve variations{.mark = Mark::points, .quiet = true};
            for (std::size_t s = 0; s < tried_.size(); ++s) {
                const auto [bytes, cpu] = equal(numbers, f, s);
                widen(x, bytes);
                widen(y, cpu);
                if (is_variation(*tried_[s])) {
                    add_point(variations, bytes, cpu);
                    continue;
                }
                auto& point = plot.curves.emplace_back(Curve{.label = std::string(tried_[s]->name),
                                                             .mark = Mark::points,
                                                             .hue = static_cast<int>(plot.curves.size())});
                add_point(point, bytes, cpu);
            }
            plot.curves.push_back(std::move(variations));
            figure.panels.push_back(std::move(plot));
        }
        for (auto& plot : figure.panels) {  // comparable
            plot.x = x;
            plot.y = y;
        }
        figure.captions.push_back(fmt::format(
            "What each setting takes to look as good as {} at crf {}: peak signal to noise and structural similarity "
            "of the whole picture and of the macroblocks that move are at least as high, by interpolation between "
            "three qualities. Grey: the default with one thing changed. Bytes are those of a film in which a frame is "
            "whole every {:g} s. Lower left is better.",
            tried_[0]->name, qualities[1], key_interval_s));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t f = 0; f < films_.size(); ++f)
            for (std::size_t s = 0; s < tried_.size(); ++s) {
                if (tried_[s]->name != "doppel") continue;
                const auto [bytes, cpu] = equal(numbers, f, s);
                all.push_back({fmt::format("film_{}_cpu", f + 1), cpu});
                all.push_back({fmt::format("film_{}_bytes", f + 1), bytes});
            }
        return all;
    }

private:
    /// The frames of a film, made when they are first asked for.
    struct Recording {
        std::once_flag once;
        RecordedFrames frames;
    };

    template <class Visit>
    static void film_fields(Visit& visit, std::string& name, VideoSpec& video) {
        visit({"scene", "a film, by name or path", "", {}, must_be_given}, name);
        visit(size_field, video.size);
        visit({"fps", "frames a second", "1/s", positive, "the film's own"}, video.fps);
        theme_field(visit, video.theme);
        visit({"transparent", "no background; of vp9", "", {}, "", {.holds = video.transparent}}, video.transparent);
    }

    void add_film(TomlReader& entry) {
        std::string name;
        VideoSpec video;
        film_fields(entry, name, video);
        entry.finish();
        if (video.transparent && codec_ != "vp9")
            throw entry.fault("transparent", "is for vp9; the codec is {}", codec_);
        auto preset = film_named(name, entry);
        preset.video.size = video.size;
        if (video.fps) preset.video.fps = video.fps, check_frames(preset, entry);
        preset.video.theme = video.theme;
        preset.video.transparent = video.transparent;
        preset.video.format = codec_ == "h264" ? FilmFormat::mp4 : FilmFormat::webm;
        preset.video.codec = codec_ == "h264" ? "" : codec_;
        TomlWriter written;
        film_fields(written, name, video);
        settings_ += "\n[[film]]\n" + written.text() + commented(resolved_toml(preset));
        films_.push_back({preset.name, make_scene(preset)});
        const auto& scene = films_.back().scene;
        if (first_frame(scene) + frames_ > scene.frames.count())
            throw entry.fault("scene", "is too short: from {} s on it has fewer than {} frames", from_s_, frames_);
    }

    long first_frame(const Scene& scene) const {
        const auto sample = std::lround(from_s_ * scene.preset.sample_hz.value());
        return scene.frames.first_from(sample * scene.frames.ticks_per_sample);
    }

    std::size_t trials_of_film() const { return static_cast<std::size_t>(repeats_) * tried_.size(); }
    const FilmToEncode& film_of(std::size_t trial) const { return films_[trial / trials_of_film()]; }
    const EncoderSetting& setting_of(std::size_t trial) const { return *tried_[trial % tried_.size()]; }
    bool is_first(std::size_t trial) const { return trial % trials_of_film() < tried_.size(); }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        auto& recording = recordings_[trial / trials_of_film()];
        std::call_once(recording.once, [&] {
            recording.frames = record(film_of(trial).scene, stop);
            time_encoding(recording.frames, options_of(trial, qualities[1]), {}, stop);  // to warm up
        });
        TrialNumbers numbers;
        for (const int crf : qualities) add_encoding(trial, recording.frames, crf, numbers, stop);
        if ((trial + 1) % trials_of_film() == 0) recording.frames = {};  // no more asked for: hundreds of MB
        return numbers;
    }

    RecordedFrames record(const Scene& scene, const std::atomic<bool>& stop) const {
        const auto& frames = scene.frames;
        const long first = first_frame(scene), end = first + frames_;
        Composer composer(scene, stop);
        Simulation simulation(scene, frames.tick(end - 1) / frames.ticks_per_sample + 2, true, stop);
        Renderer renderer(scene.preset.video.size, composer.backdrop(), Gl::automatic, stop,
                          scene.preset.video.typeface);
        RecordedFrames recorded{scene.preset.video.size, {}};
        const auto pixels = scene.preset.video.transparent ? AV_PIX_FMT_YUVA420P : AV_PIX_FMT_YUV420P;
        for (long frame = 0; frame < end;) {
            const auto snapshot = simulation.next();
            composer.add(snapshot);
            if (snapshot.pair.tick != frames.tick(frame) || frame++ < first) continue;
            const auto& picture = renderer.draw(composer.frame(), stop);
            convert(picture, renderer.changed(), pixels, recorded.frames.emplace_back());
        }
        return recorded;
    }

    VideoOptions options_of(std::size_t trial, int crf) const {
        auto options = video_options(film_of(trial).scene);
        options.preset = setting_of(trial).preset;
        options.crf = codec_ == "h264" ? crf : 2 * crf;  // of VP9 and AV1 up to 63
        return options;
    }

    /// An EncodedRow, or for a repeat its CPU time alone.
    void add_encoding(std::size_t trial, const RecordedFrames& recorded, int crf, TrialNumbers& numbers,
                      const std::atomic<bool>& stop) const {
        const auto options = options_of(trial, crf);
        const auto changes = changes_of(setting_of(trial), options.crf);
        const auto frames = static_cast<double>(recorded.frames.size());
        const double rate = static_cast<double>(options.fps_numerator) / options.fps_denominator;
        if (!is_first(trial)) {
            numbers.push_back(1e3 * time_encoding(recorded, options, changes, stop).cpu_s / frames);
            return;
        }
        const auto encoded = try_encoding(recorded, options, changes, stop);
        append(numbers,
               EncodedRow{static_cast<double>(options.crf), 1e3 * encoded.cpu_s / frames,
                          bytes_per_frame(encoded, recorded.frames.size(), rate), finite(encoded.whole.psnr_db),
                          finite(encoded.moving.psnr_db), encoded.whole.ssim, encoded.moving.ssim});
    }

    /// Of a setting on a film, at each quality.
    std::vector<EncodedRow> rows(std::span<const TrialNumbers> numbers, std::size_t film, std::size_t setting) const {
        const auto trial = film * trials_of_film() + setting;
        auto all = rows_of<EncodedRow>(numbers[trial]);
        for (auto other = trial + tried_.size(); other < (film + 1) * trials_of_film(); other += tried_.size())
            for (std::size_t q = 0; q < all.size(); ++q) all[q].cpu_ms = std::min(all[q].cpu_ms, numbers[other][q]);
        return all;
    }

    EqualQuality equal(std::span<const TrialNumbers> numbers, std::size_t film, std::size_t setting) const {
        return equal_quality(rows(numbers, film, setting), rows(numbers, film, 0));
    }

    std::string codec_ = "h264";
    double from_s_ = 5;
    int frames_ = 240, repeats_ = 3;
    std::vector<FilmToEncode> films_;
    std::vector<const EncoderSetting*> tried_;
    std::unique_ptr<Recording[]> recordings_;
};

}  // namespace

const FigureKind encoders_kind = kind_of<Encoders>("encoders", FigureKind::System::none);

}  // namespace doppel
