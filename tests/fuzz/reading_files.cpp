#include "base/error.hpp"
#include "figure/run.hpp"
#include "fuzz/reading.hpp"
#include "output/png.hpp"
#include "output/written.hpp"
#include "render/font.hpp"
#include "render/font_files.hpp"

#include <libdeflate.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace doppel::test {
namespace {

namespace fs = std::filesystem;

/// A temporary file with these bytes.
class File {
public:
    explicit File(std::string_view bytes)
        : path_(fs::temp_directory_path() / fmt::format("doppel-reading-{}", getpid())) {
        std::ofstream(path_, std::ios::binary) << bytes;
    }
    ~File() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Reads, and expects that an error names the file.
template <class Read>
std::string refusal_of(std::string_view bytes, const Read& read) {
    const File file(bytes);
    try {
        read(file.path());
        return {};
    } catch (const Error& error) {
        const std::string message = error.what();
        if (error.code() != ExitCode::io_failed) throw std::logic_error("not exit 4: " + message);
        if (!message.starts_with(file.path().string())) throw std::logic_error("names no file: " + message);
        return message;
    }
}

/// A small figure of each kind.
const std::map<std::string, FigurePreset>& figures() {
    static const auto all = [] {
        std::map<std::string, FigurePreset> made;
        const std::vector<std::pair<const char*, std::vector<const char*>>> presets{
            {"fig2-right", {"grid.x.to=2", "scene.duration_s=0.1", "grid.right=\"exponent\""}},
            {"fig3-right", {"grid.x.to=0.03", "scene.duration_s=0.1"}},
            {"fig2-left", {"scene.duration_s=0.05"}},
            {"fig6", {"scene.duration_s=0.05", "series.logarithmic=true"}},
            {"why-they-part",
             {"scene.duration_s=0.5", "grid.color.values=[\"euler\"]", "grid.x.points=2", "grid.x.to=0.004"}},
            {"lyapunov-spectrum", {"series.samples=2"}},
            {"poincare", {"section.energy_J=[9.8]", "section.orbits=2", "section.crossings=3"}},
            {"flip-map", {"grid.x.points=3", "grid.y.points=4"}},
            {"links", {"grid.x.to=3"}},
            {"drift", {"series.duration_s=10", "series.methods=[\"rk4\"]", "series.points_per_decade=2"}},
            {"stability", {"grid.y.points=2", "grid.x.points=2", "grid.panel.values=[\"rk4\", \"taylor\"]"}},
            {"speed-accuracy",
             {"work_precision.problems=[\"P1\"]", "work_precision.models=[\"angles\"]",
              "work_precision.methods=[\"rk4\"]", "work_precision.repeats=2"}}};
        for (const auto& [name, arguments] : presets) {
            std::vector<Override> overrides;
            for (const auto* argument : arguments) overrides.push_back(parse_set(argument));
            made.emplace(name, read_figure(find_preset(name), overrides));
        }
        return made;
    }();
    return all;
}

/// Each trial with its number of values, all 1.
KnownTrials plain_trials(const Experiment& work) {
    KnownTrials trials(work.trials());
    for (std::size_t i = 0; i < trials.size(); ++i)
        while (!work.fits(i, trials[i])) trials[i].push_back(1);
    return trials;
}

/// Draws and writes the trials of the file together with plain ones.
void show(const FigurePreset& figure, PartFile& part) {
    auto trials = plain_trials(*figure.experiment);
    part.take(*figure.experiment, trials);
    for (std::size_t i = 0; i < trials.size(); ++i)
        if (!figure.experiment->fits(i, trials[i])) throw std::logic_error("numbers that do not fit were taken");
    Csv table(std::filesystem::path("/dev/null"), figure.experiment->columns());
    figure.experiment->write_rows(trials, table);
    table.finish();
    try {
        compose_figure(figure, trials);
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;  // nothing to draw
    }
}

template <class T>
void append(std::string& bytes, T number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// The file that PartWriter makes of lines "TRIAL,NUMBERS;?": each becomes a block. Other lines stay.
std::string with_blocks(std::string_view input) {
    std::istringstream lines{std::string(input)};
    std::string line, text;
    std::getline(lines, line);
    text = line + (lines.eof() ? "" : "\n");
    while (std::getline(lines, line)) {
        if (!line.ends_with(";?")) {
            text += line + (lines.eof() ? "" : "\n");
            continue;
        }
        std::istringstream words(line.substr(0, line.size() - 2));
        std::vector<std::string> numbers;
        for (std::string word; std::getline(words, word, ',');) numbers.push_back(word);
        std::string block;
        append<std::uint64_t>(block, numbers.empty() ? 0 : std::strtoull(numbers[0].c_str(), nullptr, 10));
        append<std::uint64_t>(block, numbers.empty() ? 0 : numbers.size() - 1);
        for (std::size_t i = 1; i < numbers.size(); ++i) append(block, std::strtod(numbers[i].c_str(), nullptr));
        append<std::uint64_t>(text, block.size());
        append<std::uint64_t>(text, libdeflate_crc32(0, block.data(), block.size()));
        text += block;
    }
    return text;
}

}  // namespace

std::string read_part(std::string_view input) {
    return refusal_of(with_blocks(input), [](const fs::path& path) {
        auto part = read_part_file(path);
        const auto figure = figures().find(part.header.figure);
        if (figure != figures().end() && part.header.trials == figure->second.experiment->trials())
            show(figure->second, part);
    });
}

namespace {

/// A PNG with valid checksums of its chunks, so that their contents are read.
std::string with_checksums_of_chunks(std::string bytes) {
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const auto length = number_at(bytes, at, 4), end = at + 8 + length;
        if (end + 4 > bytes.size()) break;
        const auto sum = libdeflate_crc32(0, &bytes[at + 4], 4 + length);
        for (std::size_t i = 0; i < 4; ++i) bytes[end + i] = static_cast<char>(sum >> (24 - 8 * i) & 0xff);
        at = end + 4;
    }
    return bytes;
}

}  // namespace

std::string read_picture(std::string_view input) {
    return refusal_of(with_checksums_of_chunks(std::string(input)), [](const fs::path& path) {
        const auto picture = read_png(path);
        const auto& size = picture.size;
        if (size.width < 1 || size.height < 1 ||
            picture.rgba.size() != 4 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height))
            throw std::logic_error("a picture of another size than its pixels");
    });
}

std::string read_font(std::string_view input) {
    const File file(input);
    std::shared_ptr<const Font> font;
    try {
        font = Font::from_file(file.path());
    } catch (const Error& error) {
        if (error.code() != ExitCode::bad_input) throw std::logic_error(std::string("not exit 2: ") + error.what());
        return error.what();
    }
    constexpr char32_t letters = 0x2400, step = 7;
    constexpr int largest = 40;  // px
    for (char32_t letter = 0; letter < letters; letter += letter < 0x100 ? 1 : step) {
        const int glyph = font->number_of(letter);
        if (glyph == 0) continue;
        for (const int pixels : {largest, 8}) {
            const auto size = static_cast<float>(pixels);
            const auto drawn = font->rasterised(glyph, size, 0.5f);
            if (!std::isfinite(font->advance(glyph, size))) throw std::logic_error("no width");
            if (std::max(drawn.size.width, drawn.size.height) > 32 * largest + 2)
                throw std::logic_error("a glyph without bounds");
        }
    }
    return {};
}

}  // namespace doppel::test
