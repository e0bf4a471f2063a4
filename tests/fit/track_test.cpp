#include "base/machine.hpp"
#include "fit/support.hpp"

#include <gtest/gtest.h>

namespace doppel::track_test {

using namespace test;

Track read(const std::vector<std::string>& texts) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < texts.size(); ++k) names.push_back(fmt::format("{}.csv", char('a' + k)));
    return tracks_of_texts(names, texts);
}

void expect_refused(const std::vector<std::string>& texts, const std::string& words) {
    const auto [code, message] = ending([&] { return read(texts); });
    EXPECT_EQ(code, ExitCode::bad_input) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
}

/// The text of a track whose angles are changed by `change`.
std::string changed(const std::function<std::pair<double, double>(double, double, double)>& change) {
    auto track = simulated(lab_arms(), Drag::own, {.pieces = 1, .piece_s = 6, .noise = 1e-4, .seed = 3});
    auto& piece = track.pieces[0];
    for (std::size_t i = 0; i < piece.size(); ++i)
        std::tie(piece.angle[0][i], piece.angle[1][i]) = change(piece.time_s[i], piece.angle[0][i], piece.angle[1][i]);
    return csv_of(piece);
}

std::string swing() {
    return changed([](double, double a, double b) { return std::pair(a, b); });
}

TEST(FitTrack, RefusesWhatIsNoTable) {
    const std::string head = "time_s,theta1_rad,theta2_rad\n";
    const std::pair<std::string, const char*> cases[]{
        {"", "a.csv: the file is empty"},
        {head, "a.csv: there are no rows"},
        {"t,theta1_rad,theta2_rad\n",
         "a.csv:1: there is no column time_s; columns are named as here, in small letters"},
        {"time_s;theta1_rad;theta2_rad\n",
         "a.csv:1: there is no column time_s; columns are separated by commas, not by"},
        {"time_s,theta1_rad,theta1_rad,theta2_rad\n", "a.csv:1: the column theta1_rad occurs twice; leave one out"},
        {"time_s,a,b\n", "there are no angles; the columns must be theta1_rad and theta2_rad, or all of x0_px"},
        {"time_s,theta1_rad\n", "a.csv:1: there is only one link, theta1_rad"},
        {"time_s,x0_px,y0_px,x1_px,y1_px\n", "or all of x0_px, y0_px (pivot), x1_px, y1_px (joint), x2_px, y2_px"},
        {"time_s,theta1_deg,theta2_deg\n", "\"theta1_deg\" is in degrees"},
        {head + "0,1\n", "a.csv:2: the row has 2 cells; the header has 3 columns"},
        {head + "0,1,2\n1,x,2\n", "a.csv:3: theta1_rad is not a number"},
        {head + "0,1,nan\n", "a.csv:2: theta2_rad is nan; leave out rows without a measurement"},
        {head + "0,1,2\n0.1,1e300,2\n", "a.csv:3: theta1_rad is beyond 1000000 rad; check its unit"},
        {head + "0,1,2\n0.1,1,2\n0.05,1,2\n",
         "a.csv:4: time_s goes from 0.1 to 0.05; rows must be in the order of time"},
        {head + "0,1,2\n5,1,2\n10,1,2\n15,1,2\n",
         "a.csv: rows are 5 s apart, and more than 0.2 s are a gap; time_s must be in seconds"},
        {"time_s,x0_px,y0_px,x1_px,y1_px,x2_px,y2_px\n0,5,5,5,5,9,9\n", "a.csv:2: two of pivot, joint"}};
    for (const auto& [text, words] : cases) expect_refused({text}, words);
}

TEST(FitTrack, RefusesTracksThatDetermineNoModel) {
    auto track = simulated(lab_arms(), Drag::own, {.pieces = 1, .piece_s = 1});
    expect_refused({csv_of(track.pieces[0])},
                   "the track is too short: 101 samples in 1 s; it needs at least 100 in 1.5 s");
    track = simulated(lab_arms(), Drag::own, {.pieces = 1, .piece_s = 0.1});
    expect_refused({swing(), csv_of(track.pieces[0])},
                   "b.csv: the piece from 0 s on is too short: 11 samples in 0.1 s");
    expect_refused({changed([](double, double a, double) { return std::pair(a, 0.3); })}, "theta2 is flat");
    expect_refused({changed([](double, double a, double) { return std::pair(a, a); })}, "both links are needed");
    expect_refused({changed([](double t, double a, double) { return std::pair(a, a + 1e-4 * std::sin(1e4 * t)); })},
                   "theta1_rad and theta2_rad are equal within noise; both links are needed");
    track = simulated(lab_arms(), Drag::own, {.pieces = 1, .piece_s = 6, .noise = 0.05, .amplitude = 0.01});
    for (auto& angle : track.pieces[0].angle)
        for (auto& value : angle) value *= 0.1;
    expect_refused({csv_of(track.pieces[0])}, "is mostly noise: it moves by 0.079 rad");
    int row = 0;
    expect_refused({changed([&](double, double, double b) { return std::pair(++row % 2 == 0 ? 90. : -90., b); })},
                   "theta1 is mostly noise: it moves by 1.8e+02 rad");
}

TEST(FitTrack, RefusesMistakesOfUnitAndOrder) {
    constexpr double degree = 180 / std::numbers::pi;
    expect_refused({changed([](double, double a, double b) { return std::pair(degree * a, degree * b); })},
                   "the angles are in degrees; they must be in radians");
    expect_refused({changed([](double, double a, double b) { return std::pair(b, a); })},
                   "theta1_rad and theta2_rad seem to be swapped: D1 B/(C D2) is");
    expect_refused({changed([](double, double a, double b) { return std::pair(degree * b, degree * a); })}, "degrees");
}

TEST(FitTrack, RefusesWhatNoDoublePendulumDoes) {
    EXPECT_EQ(ending([] { return read({swing()}); }), Thrown(ExitCode::done, "no error"));
    std::mt19937_64 random(1);
    std::normal_distribution<double> step(0, 0.02);
    double a = 0, b = 0;
    for (const auto& text :
         {// two independent oscillators
          changed([](double t, double, double) { return std::pair(std::sin(7.3 * t), 0.8 * std::cos(4.1 * t)); }),
          // a driven motion
          changed([](double t, double one, double two) { return std::pair(one + 0.5 * std::sin(11 * t), two); }),
          // random walks
          changed([&](double, double, double) { return std::pair(a += step(random), b += step(random)); })}) {
        const auto [code, words] = ending([&] { return read({text}); });
        EXPECT_TRUE(code == ExitCode::bad_input || code == ExitCode::method_failed) << words;
    }
}

TEST(FitTrack, TakesOtherConventionsAndSaysSo) {
    const auto straight = read({swing()});
    EXPECT_TRUE(straight.notes.empty());
    constexpr double half = std::numbers::pi / 2;
    for (const auto& text : {changed([](double, double a, double b) { return std::pair(a + half, b + half); }),
                             changed([](double, double a, double b) { return std::pair(a - 2 * half, b - 2 * half); }),
                             changed([](double, double a, double b) { return std::pair(a, b - a); }),
                             changed([](double, double a, double b) { return std::pair(a, -b); })}) {
        const auto track = read({text});
        EXPECT_EQ(track.notes.size(), 1u);
        for (std::size_t arm = 0; arm < 2; ++arm)
            for (std::size_t i = 0; i < track.samples(); i += 50)
                EXPECT_NEAR(std::remainder(track.pieces[0].angle[arm][i] - straight.pieces[0].angle[arm][i], 4 * half),
                            0, 1e-8);
    }
    // both angles mirrored is also valid, and needs no note
    EXPECT_TRUE(read({changed([](double, double a, double b) { return std::pair(-a, -b); })}).notes.empty());
}

TEST(FitTrack, ReadsPlacesInAPicture) {
    const auto straight = read({swing()});
    std::string text = "frame,time_s,x0_px,y0_px,x1_px,y1_px,x2_px,y2_px\r\n";
    const auto& piece = straight.pieces[0];
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const double a = piece.angle[0][i], b = piece.angle[1][i];
        const double x1 = 500 + 200 * std::sin(a), y1 = 300 + 200 * std::cos(a);
        text += fmt::format("{},{},500,300,{},{},{},{}\r\n", i, piece.time_s[i], x1, y1, x1 + 150 * std::sin(b),
                            y1 + 150 * std::cos(b));
    }
    const auto track = read({text});
    for (std::size_t arm = 0; arm < 2; ++arm)
        for (std::size_t i = 0; i < track.samples(); ++i)
            EXPECT_NEAR(track.pieces[0].angle[arm][i], piece.angle[arm][i], 1e-12);
}

TEST(FitTrack, CutsAtGapsAndNumbersAndJoinsTurns) {
    const auto piece = simulated(lab_arms(), Drag::own, {.pieces = 1, .piece_s = 8}).pieces[0];
    std::string gap = "time_s,theta1_rad,theta2_rad,piece\n", wrapped = "time_s,theta1_rad,theta2_rad\n",
                fragment = wrapped;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const double t = piece.time_s[i], a = piece.angle[0][i], b = piece.angle[1][i];
        if (i < 200 || i > 240) gap += fmt::format("{},{},{},{}\n", i < 400 ? t : t - 4, a, b, i < 400 ? 1 : 2);
        wrapped += fmt::format("{},{},{}\n", t, std::remainder(a + 2.5, 2 * std::numbers::pi) - 2.5, b);
        if (i < 400 || (i > 440 && i < 446) || i > 480) fragment += fmt::format("{},{},{}\n", t, a, b);
    }
    const auto cut = read({gap});
    ASSERT_EQ(cut.pieces.size(), 3u);  // a gap of 0.42 s, and the number
    EXPECT_TRUE(cut.start_s.empty());  // the clock of the last piece starts again
    const auto joined = read({wrapped});
    EXPECT_EQ(joined.start_s, std::vector<double>{0});
    for (std::size_t i = 1; i < joined.samples(); ++i)
        EXPECT_LT(std::abs(joined.pieces[0].angle[0][i] - joined.pieces[0].angle[0][i - 1]), 1);
    const auto without = read({fragment});
    EXPECT_EQ(without.start_s, (std::vector{0, 4.81}));
    EXPECT_EQ(without.notes.at(0), "1 fragments between gaps, shorter than 12 samples or 0.25 s, were left out");
}

/// 100 000 pieces of one row each.
TEST(FitTrack, ManyPiecesTakeAsLongAsTheirRows) {
    std::string text = "time_s,theta1_rad,theta2_rad,piece\n";
    for (int i = 0; i < 100'000; ++i) text += fmt::format("{},0.1,0.2,{}\n", 0.01 * i, i);
    const double start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    EXPECT_THROW(read({text}), Error);
    EXPECT_LT(seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start, 3);  // measured 0.08 s; 27 s when quadratic
}

TEST(FitTrack, LeavesOutliersOut) {
    auto track = simulated(lab_arms(), Drag::own, {.pieces = 1, .piece_s = 6, .noise = 1e-3});
    for (const std::size_t i : {50, 120, 333}) track.pieces[0].angle[1][i] += 0.3;
    const auto read_again = read({csv_of(track.pieces[0])});
    EXPECT_EQ(read_again.outliers(), 3u);
    for (const std::size_t i : {50, 120, 333}) EXPECT_EQ(read_again.pieces[0].is_outlier[1][i], 1);
    EXPECT_EQ(read_again.notes.at(0), "3 of 1202 angles are outliers, and were left out");
    EXPECT_NEAR(read_again.noise[0], 1e-3, 1e-4);  // measured 1.01e-3
}

/// Joints that stick again and again.
TEST(FitTrack, TakesNoKinkOfFrictionForAnOutlier) {
    auto truth = lab_arms();
    for (const double coulomb : {0.1, 1.0, 5.0})
        for (const double hz : {100, 500}) {
            truth[coulomb_1] = truth[coulomb_2] = coulomb;
            const auto track = simulated(truth, Drag::own, {.pieces = 1, .piece_s = 12, .hz = hz});
            EXPECT_EQ(read({csv_of(track.pieces[0])}).outliers(), 0u) << coulomb << ' ' << hz;  // there were up to 200
        }
}

}  // namespace doppel::track_test
