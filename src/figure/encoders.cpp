#include "figure/encoder_settings.hpp"
#include "figure/kinds.hpp"
#include "film/film.hpp"
#include "output/encoding_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

namespace doppel {
namespace {

/// crf at which each is tried: the one compared with in the middle.
constexpr std::array qualities{15, 18, 21};

/// What came of a setting at one quality, a frame.
struct EncodedRow {
    double crf, cpu_ms, bytes, psnr_db, moving_psnr_db, ssim, moving_ssim;
};

/// What a setting takes to look as good as the first at its middle quality, in units of what that takes.
struct EqualQuality {
    double bytes, cpu;
};

/// A film to be encoded.
struct FilmToEncode {
    std::string name;
    Scene scene;
};

Metadata changes_of(const EncoderSetting& setting, int crf) {
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

/// The four measures of quality, each so that it goes about evenly with the logarithm of the bytes.
std::array<double, 4> measures_of(const EncodedRow& row) {
    const auto decibels = [](double ssim) { return -10 * std::log10(1 - ssim); };
    return {row.psnr_db, row.moving_psnr_db, decibels(row.ssim), decibels(row.moving_ssim)};
}

/// y at x of the straight line through the two of the points (x falling) that are nearest to x; NaN if they are one.
double along(double x, std::span<const double> xs, std::span<const double> ys) {
    std::size_t k = 0;
    while (k + 2 < xs.size() && x < xs[k + 1]) ++k;
    if (xs[k + 1] == xs[k]) return std::numeric_limits<double>::quiet_NaN();
    return ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k]);
}

/// By interpolation between the qualities that were tried; the worst of the measures counts.
EqualQuality equal_quality(std::span<const EncodedRow> rows, std::span<const EncodedRow> reference) {
    const auto& wanted = reference[reference.size() / 2];
    std::vector<double> log_bytes, cpu;
    for (const auto& row : rows) {
        log_bytes.push_back(std::log(row.bytes));
        cpu.push_back(row.cpu_ms);
    }
    double needed = -std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < 4; ++m) {
        std::vector<double> measure;
        for (const auto& row : rows) measure.push_back(measures_of(row)[m]);
        needed = std::max(needed, along(measures_of(wanted)[m], measure, log_bytes));
    }
    return {.bytes = std::exp(needed) / wanted.bytes, .cpu = along(needed, log_bytes, cpu) / wanted.cpu_ms};
}

/// What encoders take for films at the same quality. A trial is a setting on a film.
class Encoders final : public Experiment {
public:
    static constexpr std::string_view table_key = "encoders";
    Encoders() = default;
    explicit Encoders(FigureReader& reader) {
        auto table = reader.settings(*this);
        settings_ = table.finish();
        for (const auto& setting : encoder_settings)
            if (setting.codec == codec_) tried_.push_back(&setting);
        const auto tables = reader.top.read_tables("film");
        if (tables.empty()) throw reader.top.fault("film", "is missing: a [[film]] each names what is encoded");
        for (std::size_t i = 0; i < tables.size(); ++i) {
            auto entry = reader.top.inner(tables[i], fmt::format("[[film]] {}", i + 1));
            add_film(entry);
        }
        recordings_ = std::make_unique<Recording[]>(films_.size());
    }

    template <class Visit>
    void fields(Visit& visit) {
        visit({.key = "codec", .help = "of the encoder", .names = encoder_codecs}, codec_);
        visit({"from_s", "of the film, where the frames begin", "s", not_negative}, from_s_);
        visit({"frames", "of each film", "", from_to(2, 100'000)}, frames_);
    }
    static FieldTable other_table() {
        FieldTable film{"[[film]]", "A film each.\n"};
        VideoSpec video;
        std::string name;
        film_fields(film, name, video);
        return film;
    }

    std::size_t trials() const override { return films_.size() * tried_.size(); }
    bool measures_time() const override { return true; }
    std::string unit() const override { return "settings"; }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        return numbers.size() == qualities.size() * numbers_in<EncodedRow> && all_finite(numbers);
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
        for (std::size_t trial = 0; trial < numbers.size(); ++trial) {
            const auto& video = film_of(trial).scene.preset.video;
            const auto [bytes, cpu] = equal(numbers, trial);
            for (const auto& row : rows_of<EncodedRow>(numbers[trial]))
                add_row(table, film_of(trial).name, video.size.width, video.size.height, video.theme,
                        setting_of(trial).name, static_cast<int>(row.crf), row.cpu_ms, row.bytes, row.psnr_db,
                        row.moving_psnr_db, row.ssim, row.moving_ssim, cpu, bytes);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        for (std::size_t f = 0; f < films_.size(); ++f) {
            const auto& video = films_[f].scene.preset.video;
            Plot plot;
            plot.title = fmt::format("{}, {}×{}, {}", films_[f].name, video.size.width, video.size.height, video.theme);
            plot.x = {.label = fmt::format("bytes, {} = 1", tried_[0]->name), .logarithmic = true};
            plot.y = {.label = fmt::format("CPU time, {} = 1", tried_[0]->name), .logarithmic = true};
            for (std::size_t s = 0; s < tried_.size(); ++s) {
                Curve point{.label = std::string(tried_[s]->name), .mark = Mark::points, .hue = static_cast<int>(s)};
                const auto [bytes, cpu] = equal(numbers, f * tried_.size() + s);
                add_point(point, bytes, cpu);
                plot.curves.push_back(std::move(point));
            }
            figure.panels.push_back(std::move(plot));
        }
        figure.captions.push_back(fmt::format(
            "What each setting takes to look as good as {} at crf {}: peak signal to noise and structural similarity "
            "of the whole picture and of the macroblocks that move are at least as high, by interpolation between "
            "three qualities. Lower left is better.",
            tried_[0]->name, qualities[1]));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t trial = 0; trial < numbers.size(); ++trial) {
            if (setting_of(trial).name != "doppel") continue;
            const auto [bytes, cpu] = equal(numbers, trial);
            const auto key = fmt::format("film_{}_", trial / tried_.size() + 1);
            all.push_back({key + "cpu", cpu});
            all.push_back({key + "bytes", bytes});
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
        theme_field(visit, video.theme);
    }

    void add_film(TomlReader& entry) {
        std::string name;
        VideoSpec video;
        film_fields(entry, name, video);
        entry.finish();
        auto preset = film_named(name, entry);
        preset.video.size = video.size;
        preset.video.theme = video.theme;
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

    const FilmToEncode& film_of(std::size_t trial) const { return films_[trial / tried_.size()]; }
    const EncoderSetting& setting_of(std::size_t trial) const { return *tried_[trial % tried_.size()]; }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        auto& recording = recordings_[trial / tried_.size()];
        std::call_once(recording.once, [&] { recording.frames = record(film_of(trial).scene, stop); });
        TrialNumbers numbers;
        for (const int crf : qualities) append(numbers, encode(trial, recording.frames, crf, stop));
        if (trial % tried_.size() + 1 == tried_.size()) recording.frames = {};  // no more asked for: hundreds of MB
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
        for (long frame = 0; frame < end;) {
            const auto snapshot = simulation.next();
            composer.add(snapshot);
            if (snapshot.pair.tick != frames.tick(frame) || frame++ < first) continue;
            const auto& picture = renderer.draw(composer.frame(), stop);
            convert(picture, renderer.changed(), AV_PIX_FMT_YUV420P, recorded.frames.emplace_back());
        }
        return recorded;
    }

    EncodedRow encode(std::size_t trial, const RecordedFrames& recorded, int crf, const std::atomic<bool>& stop) const {
        auto options = video_options(film_of(trial).scene);
        options.preset = setting_of(trial).preset;
        options.crf = codec_ == "h264" ? crf : 2 * crf;  // of VP9 and AV1 up to 63
        const auto encoded = try_encoding(recorded, options, changes_of(setting_of(trial), options.crf), stop);
        const auto frames = static_cast<double>(recorded.frames.size());
        return {static_cast<double>(options.crf),
                1e3 * encoded.cpu_s / frames,
                static_cast<double>(encoded.bytes) / frames,
                encoded.whole.psnr_db,
                encoded.moving.psnr_db,
                encoded.whole.ssim,
                encoded.moving.ssim};
    }

    EqualQuality equal(std::span<const TrialNumbers> numbers, std::size_t trial) const {
        const auto reference = trial - trial % tried_.size();
        return equal_quality(rows_of<EncodedRow>(numbers[trial]), rows_of<EncodedRow>(numbers[reference]));
    }

    std::string codec_ = "h264";
    double from_s_ = 5;
    int frames_ = 240;
    std::vector<FilmToEncode> films_;
    std::vector<const EncoderSetting*> tried_;
    std::unique_ptr<Recording[]> recordings_;
};

}  // namespace

const FigureKind encoders_kind = kind_of<Encoders>("encoders", FigureKind::System::none);

}  // namespace doppel
