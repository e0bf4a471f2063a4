// Films in parts, recordings, events and chapters.
#include "errors.hpp"
#include "film/film.hpp"
#include "film/recording.hpp"
#include "film/runs.hpp"
#include "output/decoded.hpp"

#include <fstream>

namespace doppel::parts_test {

namespace fs = std::filesystem;
using namespace test;

/// 12 s in 145 frames: eight segments of 18 frames, the last of 19.
Scene film(std::vector<std::string> more = {}, const std::string& duration_s = "12") {
    more.insert(more.begin(), {"video.size=[96, 64]", "scene.duration_s=" + duration_s, "video.fps=12"});
    return scene_of("butterfly", more);
}

nlohmann::json manifest_in(const fs::path& out) {
    auto manifest = nlohmann::json::parse(bytes_of(out / "butterfly/butterfly.json"));
    manifest.erase("time");
    return manifest;
}

/// Renders two parts and joins them.
void render_in_parts(const Scene& scene, RunOptions options) {
    for (const int number : {2, 1}) {
        options.shard = Shard{number, 2};
        render(scene, options);
    }
    options.shard.reset();
    options.merge = true;
    render(scene, options);
}

void expect_same_files(const fs::path& one, const fs::path& joined) {
    for (const auto& entry : fs::recursive_directory_iterator(one)) {
        if (!entry.is_regular_file() || entry.path().extension() == ".json") continue;
        const auto other = joined / fs::relative(entry.path(), one);
        ASSERT_TRUE(fs::exists(other)) << other;
        EXPECT_EQ(bytes_of(entry.path()), bytes_of(other)) << other;
    }
    EXPECT_EQ(manifest_in(one), manifest_in(joined));
}

TEST(FilmParts, JoinedAreTheBytesOfOneRun) {
    const std::vector<std::vector<std::string>> cases{
        {},
        {"video.preset=medium"},
        {"video.format=webm", "video.transparent=true"},
        {"video.format=webm", "video.codec=av1"},
        {"video.format=png"},
        {"video.title_card_s=1", "video.hold_end_s=1", "video.end_card_s=2", "video.poster_s=1.5",
         "video.contact_sheet=[2, 1]"},
        {"video.speed=[[0, 1], [1, 0.5]]"}};
    for (const auto& more : cases) {
        const auto scene = film(more, "2");  // two segments, more with cards and with slow motion
        EXPECT_GE(max_shards(scene), 2);
        const auto folder = fresh_folder();
        render(scene, {.out = folder / "one"});
        render_in_parts(scene, {.out = folder / "parts"});
        expect_same_files(folder / "one", folder / "parts");
    }
}

TEST(FilmParts, HaveAllFramesAtEvenTimes) {
    const auto scene = film();
    EXPECT_EQ(max_shards(scene), 8);
    const auto first = frames_of(scene, {1, 2}), second = frames_of(scene, {2, 2});
    EXPECT_EQ((std::array{first.last, second.first, second.last}), (std::array{72L, 72L, 145L}));
    const auto folder = fresh_folder();
    render_in_parts(scene, {.out = folder});
    const auto video = read_video(folder / "butterfly/butterfly.mp4");
    ASSERT_EQ(video.times.size(), 145U);
    EXPECT_EQ(video.average_rate, (Ratio{12, 1}));
    for (long k = 0; k < 145; ++k) EXPECT_EQ(video.times[static_cast<std::size_t>(k)], (Ratio{k, 12})) << k;
}

TEST(FilmParts, OfACompletePartNothingIsDone) {
    const auto scene = film();
    const auto folder = fresh_folder();
    const RunOptions first{.out = folder, .shard = Shard{1, 2}};
    EXPECT_EQ(render(scene, first).frames, 72);
    const auto part = folder / "butterfly/butterfly.1-of-2.shard";
    EXPECT_EQ(files_in(folder / "butterfly"), (std::set<std::string>{"butterfly.1-of-2.shard"}));
    const auto made = fs::last_write_time(part);
    const auto again = render(scene, first);
    EXPECT_EQ(again.frames, 0);
    EXPECT_EQ(again.files, (std::vector{part}));
    EXPECT_EQ(fs::last_write_time(part), made);
    fs::resize_file(part, fs::file_size(part) - 10);  // a copy that was cut off is made again
    EXPECT_EQ(render(scene, first).frames, 72);
}

TEST(FilmParts, AreRefusedIfTheyDoNotFit) {
    const auto folder = fresh_folder();
    const auto scene = film();
    const auto merge = [&] { render(scene, {.out = folder, .merge = true}); };
    const auto place = (folder / "butterfly").string();
    EXPECT_EQ(thrown_by(merge).first, ExitCode::try_again);
    render(scene, {.out = folder, .shard = Shard{2, 2}});
    EXPECT_EQ(thrown_by(merge), (Thrown{ExitCode::try_again, place + ": missing shards: 1/2"}));
    test::expect_error(ExitCode::bad_input,
                       {place + "/butterfly.2-of-2.shard was made with another preset, --set, --size or --format"},
                       [&] { render(film({"video.theme=light"}), {.out = folder, .merge = true}); });
    render(scene, {.out = folder, .shard = Shard{1, 2}});
    render(scene, {.out = folder, .shard = Shard{1, 1}});
    EXPECT_EQ(thrown_by(merge).first, ExitCode::bad_input);
    fs::remove(folder / "butterfly/butterfly.1-of-1.shard");
    std::fstream part(folder / "butterfly/butterfly.1-of-2.shard", std::ios::in | std::ios::out | std::ios::binary);
    part.seekp(-100, std::ios::end);
    part.put('x').put('y');
    part.close();
    test::expect_error(ExitCode::io_failed, {"1-of-2.shard is damaged"}, merge);
}

TEST(FilmParts, AreRefusedIfTheirHeaderIsDamaged) {
    const auto folder = fresh_folder();
    fs::create_directory(folder / "butterfly");
    const auto part = folder / "butterfly/butterfly.0-of-0.shard";
    for (const std::string numbers :
         {"", ",\"shard\":0,\"of\":0", ",\"shard\":2,\"of\":1", ",\"shard\":\"1\",\"of\":1"}) {
        write_bytes(part, std::string(film_part.start) + numbers + "}\nend\n");
        EXPECT_EQ(thrown_by([&] { render(film(), {.out = folder, .merge = true}); }),
                  (Thrown{ExitCode::io_failed,
                          part.string() + " is damaged or incomplete; remove it, and render this part again"}))
            << numbers;
    }
}

TEST(FilmParts, NeedAFormatThatCanBeJoined) {
    const auto refused = [](const Scene& scene, const RunOptions& options) {
        return thrown_by([&] { check_run(scene, options); });
    };
    const auto gif = film({"video.format=gif"});
    EXPECT_EQ(max_shards(gif), 1);
    EXPECT_EQ(refused(gif, {.shard = Shard{1, 2}}),
              (Thrown{ExitCode::bad_input,
                      "--shard: a film in the format GIF cannot be joined from parts; use mp4, webm or png"}));
    EXPECT_EQ(refused(film(), {.shard = Shard{1, 9}}),
              (Thrown{ExitCode::bad_input, "--shard 1/9: butterfly can have 8 shards at most"}));
    EXPECT_EQ(refused(film(), {.first = 5, .shard = Shard{1, 2}}).first, ExitCode::bad_input);
}

TEST(Recordings, GiveTheSameFilm) {
    const std::vector<std::vector<std::string>> cases{{},
                                                      {"video.fps=25"},  // frames between samples
                                                      {"system.integrator=taylor", "system.precision=quad"},
                                                      {"video.layout=ensemble", "video.members=3"}};
    for (const auto& more : cases) {
        auto keys = more;
        keys.insert(keys.begin(), {"video.size=[96, 64]", "scene.duration_s=0.5"});
        const auto scene = scene_of("butterfly", keys);
        const auto folder = fresh_folder();
        render(scene, {.out = folder / "table", .pictures = false, .record_to = folder / "motion"});
        render(scene, {.out = folder / "one"});
        render(scene, {.out = folder / "read", .recording = folder / "motion"});
        expect_same_files(folder / "one", folder / "read");
    }
}

TEST(Recordings, AreRefusedIfTheyDoNotFit) {
    const auto folder = fresh_folder();
    const auto file = folder / "motion";
    render(small_scene(), {.out = folder, .pictures = false, .record_to = file});
    const auto read = [&](const std::vector<std::string>& keys) {
        return thrown_by([&] { render(small_scene(keys), {.out = folder, .recording = file}); });
    };
    // only the pictures differ, or the table
    for (const char* key : {"video.theme=light", "video.layout=overlay", "scene.energy_columns=true", "title=\"Mine\"",
                            "a.label=\"one\""})
        EXPECT_EQ(read({key}).first, ExitCode::done) << key;
    EXPECT_EQ(read({"video.layout=ensemble"}).first, ExitCode::bad_input);
    EXPECT_EQ(read({"system.gravity_m_per_s2=9"}).first, ExitCode::bad_input);
    fs::resize_file(file, fs::file_size(file) / 2);
    EXPECT_EQ(read({}), (Thrown{ExitCode::io_failed,
                                file.string() + " is damaged or incomplete; make it again with simulate --recording"}));
    write_bytes(file, "hello\n");
    EXPECT_EQ(read({}), (Thrown{ExitCode::io_failed, file.string() + " is no recording of Doppel"}));
}

/// A link that turns once a second in one direction: it is upright at 0.5 s, 1.5 s ….
TEST(Events, FlipsAreWhereALinkIsUpright) {
    const auto scene =
        scene_of("butterfly", {"system.links=1", "system.mass_kg=[1]", "system.length_m=[1]", "system.angle_deg=[0]",
                               "b.angle_deg=[0.001]", "system.omega_deg_per_s=[360]", "system.gravity_m_per_s2=1e-9",
                               "system.integrator=rk4", "system.step_s=\"1/1200\"", "scene.duration_s=3"});
    Outcome outcome;
    for_each_snapshot(scene, scene.samples, [&](const Snapshot& snapshot) { outcome.add(scene, snapshot.pair); });
    std::vector<double> times;
    for (const auto& flip : outcome.flips)
        if (flip.side == 'a') times.push_back(flip.time_s);
    ASSERT_EQ(times.size(), 3U);
    // a sample is 1/120 s
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(times[static_cast<std::size_t>(k)], 0.5 + k, 1.0 / 120) << k;
}

TEST(Events, AreInTheManifestAndChaptersOfTheFilm) {
    // the film of butterfly: released at 0 s, first flip of both at 10.73 s; the speed changes at 4 s
    const auto scene = film({"video.speed=[[0, 1], [4, 2]]", "video.title_card_s=1"});
    const auto folder = fresh_folder();
    render(scene, {.out = folder});
    const auto events = manifest_in(folder)["events"];
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events[0], (nlohmann::json{{"event", "release"}, {"time_s", 0}, {"film_s", 1}}));
    EXPECT_EQ(events[1]["event"], "speed");
    EXPECT_EQ(events[1]["speed"], "2");
    EXPECT_EQ(events[2]["event"], "flip");
    EXPECT_EQ(events[2]["side"], "a");
    EXPECT_EQ(events[2]["link"], 2);
    EXPECT_NEAR(events[2]["time_s"], 10.73, 0.01);
    std::vector<std::string> titles;
    for (const auto& [frame, title] : chapters_of(scene, film_events(scene, {.flips = {{10.73, 'a', 2}, {11, 'a', 1}}}),
                                                  {0, schedule_of(scene).frames()}))
        titles.push_back(title);
    EXPECT_EQ(titles, (std::vector<std::string>{scene.preset.title, "Release", "Speed 2", "A: link 2 flips"}));
    const auto video = read_video(folder / "butterfly/butterfly.mp4");
    ASSERT_EQ(video.chapters.size(), 4U);
    EXPECT_EQ(video.chapters[3].second, "A: link 2 flips");
    EXPECT_NEAR(video.chapters[3].first, events[2]["film_s"].get<double>(), 1e-3);
}

TEST(Events, OfAPartOfAFilmAreThoseThatItShows) {
    // of 9 to 12 s: the first flip, at 10.73 s, is 1.73 s after the part's start; frames are 1/12 s apart
    for (const char* format : {"mp4", "webm"}) {
        const auto scene = film({std::string("video.format=") + format});
        const auto folder = fresh_folder();
        render(scene, {.out = folder, .from_s = Rational{9, 1}, .to_s = Rational{12, 1}});
        const auto events = manifest_in(folder)["events"];
        ASSERT_FALSE(events.empty());
        EXPECT_EQ(events[0]["event"], "flip");
        for (const auto& event : events)
            EXPECT_NEAR(event["film_s"].get<double>(), event["time_s"].get<double>() - 9, 1.0 / 12) << event;
        const auto video = read_video(folder / fmt::format("butterfly/butterfly.{}", format));
        ASSERT_GE(video.chapters.size(), 2U);
        EXPECT_EQ(video.chapters[0], std::pair(0.0, scene.preset.title));
        EXPECT_NEAR(video.chapters[1].first, 1.73, 1.0 / 12);
    }
    // 0.23 s after the start of a part, a flip has no chapter
    const auto scene = film();
    for (const auto& [frame, title] : chapters_of(scene, film_events(scene, {.flips = {{10.73, 'a', 2}}}), {126, 144}))
        EXPECT_EQ(std::pair(frame, title), std::pair(0L, scene.preset.title));
}

}  // namespace doppel::parts_test
