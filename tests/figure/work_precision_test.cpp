#include "figure/work_precision.hpp"

#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

namespace doppel::work_precision_test {

const std::string by_evaluations = "chart.cost=\"evaluations\"";

/// A film of one second, and its figure.
std::string film_path() {
    const auto path = std::filesystem::path(DOPPEL_TEST_OUTPUT) / fmt::format("film-{}.toml", getpid());
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "[scene]\nduration_s = 1\n[system]\nangle_deg = [90, 90]\n";
    return path;
}

FigurePreset second(const std::vector<std::string>& more = {}, const std::string& cost = "evaluations") {
    static const auto path = film_path();
    return figure_from(fmt::format("[scene]\nkind = \"work-precision\"\n[work_precision]\nscene = \"{}\"\n"
                                   "[chart]\ncost = \"{}\"\n",
                                   path, cost),
                       more);
}

/// The words and numbers of a row, by column.
struct Row {
    std::map<std::string, std::string> cells;
    double number(const std::string& column) const {
        double value = std::numeric_limits<double>::quiet_NaN();
        const auto& text = cells.at(column);
        std::from_chars(text.data(), text.data() + text.size(), value);
        return value;
    }
};

std::vector<Row> rows_of(const std::string& text) {
    const Table table(text);
    std::vector<Row> rows(table.words.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t k = 0; k < table.columns.size(); ++k) rows[i].cells[table.columns[k]] = table.words[i].at(k);
    return rows;
}

std::vector<Row> rows_of(const FigurePreset& figure) {
    return rows_of(table_text(figure, computed(figure)));
}

const WorkComparison& compared_in(const FigurePreset& figure) {
    return dynamic_cast<const WorkComparison&>(*figure.experiment);
}

TEST(WorkPrecision, NamesTheSystem) {
    const std::vector<std::string> quick{"work_precision.methods=[\"rk4\"]", "work_precision.models=[\"angles\"]",
                                         "work_precision.most_evaluations=1000"};
    auto arguments = quick;
    arguments.insert(arguments.end(), {by_evaluations, "work_precision.problems=[\"P3\"]"});
    EXPECT_EQ(figure_of("speed-accuracy", arguments).subtitle,
              "pendulums released at rest, links of 1 m and 1 kg, g = 9.8 m/s²; double precision, one core");
    const auto path = std::filesystem::path(DOPPEL_TEST_OUTPUT) / fmt::format("uneven-{}.toml", getpid());
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "[scene]\nduration_s = 1\n[system]\nlength_m = [1, 0.5]\nmass_kg = 3\n"
                           "omega_deg_per_s = [10, 0]\ngravity_m_per_s2 = 3.7\n";
    arguments = quick;
    arguments.insert(arguments.end(), {by_evaluations, fmt::format("work_precision.scene=\"{}\"", path.string())});
    EXPECT_EQ(figure_of("speed-accuracy", arguments).subtitle,
              fmt::format("side a of uneven-{}: a double pendulum released from 90°/90° at 10/0 °/s, links of 1/0.5 m "
                          "and 3 kg, g = 3.7 m/s²; double precision, one core",
                          getpid()));
    std::filesystem::remove(path);
}

TEST(WorkPrecision, HasTheColumnsAndEveryStudy) {
    const auto figure =
        second({"work_precision.methods=[\"rk4\", \"rattle\", \"taylor\"]", "work_precision.most_evaluations=20000"});
    EXPECT_EQ(header_line(figure),
              "problem,model,method,setting,angle_error_rad,energy_error,length_error_m,cpu_seconds,evaluations,steps");
    std::map<std::string, int> outcomes;
    for (const auto& row : rows_of(figure)) {
        ++outcomes[row.cells.at("model") + " " + row.cells.at("method")];
        EXPECT_EQ(row.cells.at("cpu_seconds"), "");
        EXPECT_GT(row.number("evaluations"), 0);
        if (row.cells.at("model") == "angles") {
            EXPECT_EQ(row.number("length_error_m"), 0);
        }
    }
    ASSERT_EQ(outcomes.size(), 3u + 3 + 2);  // rattle does not support angles
    for (const auto& [name, count] : outcomes) EXPECT_GT(count, 10) << name;
}

TEST(WorkPrecision, FallsByThePowerOfEachOrder) {
    const auto rows = rows_of(second({"work_precision.models=[\"angles\", \"constraints\"]",
                                      "work_precision.methods=[\"euler\", \"semi-implicit-euler\", \"midpoint\", "
                                      "\"rk4\", \"gauss4\", \"gauss6\", \"rattle\", \"rattle6\"]",
                                      "work_precision.most_evaluations=60000", "work_precision.least_error=1e-11"}));
    struct Order {
        double is, within;
    };
    // measured within 9e-4, 6e-4, 1.7e-3, 0.025, 2e-4, 0.18, 1.1e-5, 0.02
    const std::map<std::string, Order> orders{{"euler", {1, 5e-3}},    {"semi-implicit-euler", {1, 5e-3}},
                                              {"midpoint", {2, 0.01}}, {"rk4", {4, 0.15}},
                                              {"gauss4", {4, 1e-3}},   {"gauss6", {6, 0.3}},
                                              {"rattle", {2, 1e-4}},   {"rattle6", {6, 0.15}}};
    std::map<std::string, std::vector<const Row*>> studies;
    for (const auto& row : rows) studies[row.cells.at("model") + " " + row.cells.at("method")].push_back(&row);
    for (const auto& [name, study] : studies) {
        // over the last one or two octaves: at finer steps round-off appears
        const auto &fine = *study.at(study.size() - 2), &coarse = *study.at(study.size() - 6);
        const double slope = std::log(coarse.number("angle_error_rad") / fine.number("angle_error_rad")) /
                             std::log(coarse.number("setting") / fine.number("setting"));
        const auto& order = orders.at(study[0]->cells.at("method"));
        EXPECT_NEAR(slope, order.is, order.within) << name;
    }
    EXPECT_EQ(studies.size(), 6u + 6);
}

/// Two uniform bars without bobs.
TEST(WorkPrecision, TakesBodies) {
    const auto figure =
        figure_of("speed-accuracy", {by_evaluations, "work_precision.scene=\"rods\"", "work_precision.duration_s=1",
                                     "work_precision.methods=[\"rk4\", \"dop853\", \"taylor\"]",
                                     "work_precision.most_evaluations=60000"});
    std::map<std::string, double> minimum;
    for (const auto& row : rows_of(figure)) {
        auto& error = minimum.try_emplace(row.cells.at("model") + " " + row.cells.at("method"), 1).first->second;
        error = std::fmin(error, row.number("angle_error_rad"));
    }
    ASSERT_EQ(minimum.size(), 3u);  // in angles only
    for (const auto& [name, error] : minimum)
        EXPECT_LT(error, name.ends_with("rk4") ? 1e-12 : 1e-14) << name;  // 2e-13, 1.5e-15
}

TEST(WorkPrecision, KnowsItsProblems) {
    const auto figure = figure_of(
        "speed-accuracy",
        {by_evaluations, "work_precision.problems=[\"P1\", \"P3\", \"P4\"]", "work_precision.models=[\"angles\"]",
         "work_precision.methods=[\"euler\", \"taylor\"]", "work_precision.most_evaluations=20000"});
    const auto trials = computed(figure);
    const auto& compared = compared_in(figure);
    const auto studies = compared.merged_studies(trials);
    for (const auto& [p, sensitivity, slack] : {std::tuple(0u, 80, 1), {1u, 320, 1}, {2u, 1040, 5}}) {
        EXPECT_NEAR(trials[p].at(0), sensitivity, slack) << p;
        EXPECT_LT(compared.reference(p, never_stopped).disagreement, 5e-30) << p;   // measured 9e-31
        EXPECT_LT(cheapest(studies[p], Cost::evaluations, 1e-12).cost, 6000) << p;  // measured 4706
    }
    // the error of the study's program at its step
    const std::map<std::string, double> study{{"P1", 0.13}, {"P3", 0.12}, {"P4", 0.66}};
    std::size_t seen = 0;
    for (const auto& row : rows_of(table_text(figure, trials))) {
        if (row.cells.at("method") != "euler" || row.number("setting") != 1.0 / 30000) continue;
        ++seen;
        EXPECT_NEAR(row.number("angle_error_rad"), study.at(row.cells.at("problem")), 0.006);
    }
    EXPECT_EQ(seen, 3u);
}

TEST(WorkPrecision, EndsAtTheFloor) {
    const auto rows =
        rows_of(second({"work_precision.models=[\"angles\"]", "work_precision.methods=[\"taylor\", \"dop853\"]"}));
    double minimum = 1;
    for (const auto& row : rows) minimum = std::fmin(minimum, row.number("angle_error_rad"));
    EXPECT_LT(minimum, 7e-16);                             // measured 2e-16
    EXPECT_GT(rows.back().number("setting"), 0.99e-15);    // the smallest that double precision allows
    EXPECT_LT(rows.back().number("energy_error"), 3e-15);  // measured 5.1e-16
}

TEST(WorkPrecision, TimesItsRuns) {
    const auto figure = second({"work_precision.models=[\"angles\"]", "work_precision.methods=[\"rk4\", \"taylor\"]",
                                "work_precision.repeats=3", "work_precision.most_evaluations=20000"},
                               "time");
    EXPECT_TRUE(figure.experiment->measures_time());
    EXPECT_EQ(figure.experiment->trials(), 1u + 3 * 2);
    double last = 0;
    for (const auto& row : rows_of(figure)) {
        const double seconds = row.number("cpu_seconds"), each = seconds / row.number("evaluations");
        EXPECT_GT(each, 1e-10);
        EXPECT_LT(each, 1e-4);
        last = seconds;
    }
    EXPECT_GT(last, 0);
}

TEST(WorkPrecision, TakesAMechanism) {
    const auto figure = figure_from(
        "[scene]\nkind = \"work-precision\"\n[work_precision]\nscene = \"springs\"\nduration_s = 0.5\n"
        "methods = [\"rk4\", \"taylor\"]\nmost_evaluations = 3000\n",
        {by_evaluations});
    EXPECT_NE(header_line(figure).find(",place_error,"), std::string::npos);
    double minimum = 1;
    for (const auto& row : rows_of(figure)) {
        EXPECT_EQ(row.cells.at("model"), "mechanism");
        EXPECT_EQ(row.cells.at("problem"), "springs");
        minimum = std::fmin(minimum, row.number("place_error"));
    }
    EXPECT_LT(minimum, 5e-16);  // measured 8.9e-17
}

TEST(WorkPrecision, FailsIfEveryRunFails) {
    const auto figure = figure_of(
        "speed-accuracy", {by_evaluations, "work_precision.problems=[\"P3\"]",
                           "work_precision.methods=[\"gauss4\", \"rattle\"]", "work_precision.most_evaluations=100"});
    const auto trials = computed(figure);
    for (const auto& row : rows_of(table_text(figure, trials)))
        EXPECT_TRUE(std::isnan(row.number("angle_error_rad"))) << row.cells.at("method");
    test::expect_error(ExitCode::method_failed, {"no run of any method has an error below 1 rad"},
                       [&] { compose_figure(figure, trials); });
    const std::string one_that_ends = "work_precision.methods=[\"gauss4\", \"taylor\"]";
    const auto other = figure_of("speed-accuracy", {by_evaluations, "work_precision.problems=[\"P3\"]", one_that_ends,
                                                    "work_precision.most_evaluations=1000"});
    EXPECT_EQ(other.experiment->nothing_to_draw(computed(other)), std::nullopt);
}

/// A diverged run may end near the true angles by chance, modulo whole turns, with energies of 1e185.
TEST(WorkPrecision, ADivergedRunHasFailed) {
    const auto figure =
        figure_of("speed-accuracy",
                  {by_evaluations, "work_precision.scene=\"butterfly\"", "work_precision.duration_s=3",
                   "work_precision.most_evaluations=30000",
                   "work_precision.methods=[\"euler\", \"semi-implicit-euler\", \"adams\", \"rk4\", \"rattle\"]"});
    const auto trials = computed(figure);
    std::map<std::string, int> failed;
    for (const auto& row : rows_of(table_text(figure, trials))) {
        const auto name = row.cells.at("model") + " " + row.cells.at("method");
        if (row.cells.at("angle_error_rad") == "failed") {
            ++failed[name];
            EXPECT_EQ(row.cells.at("energy_error") + row.cells.at("length_error_m"), "") << name;
            EXPECT_GT(row.number("evaluations"), 0) << name;
            continue;
        }
        EXPECT_LE(row.number("angle_error_rad"), pi) << name;
        EXPECT_LT(row.number("energy_error"), 25) << name;  // relative to the potential range, as E0 = 0
        EXPECT_LT(row.number("length_error_m"), 2) << name;
    }
    for (const auto* name : {"angles euler", "angles adams", "constraints euler", "mechanism adams"})
        EXPECT_GT(failed[name], 0) << name;
    EXPECT_EQ(failed["constraints rattle"], 3);  // its iteration for the multipliers does not converge
    const auto studies = compared_in(figure).merged_studies(trials)[0];
    const auto best = cheapest(studies, Cost::evaluations, 1e-12);
    EXPECT_EQ(best.study->solver.method, "adams");
    EXPECT_EQ(best.study->solver.model, Model::angles);
    EXPECT_GT(best.cost, 1000);  // was 93, of an energy of 1e185
    EXPECT_NE(cheapest(studies, Cost::evaluations, 1e-3).study->solver.method, "euler");
}

TEST(WorkPrecision, ResolvedReadsBackToTheSame) {
    for (const auto& figure : {second({"work_precision.repeats=4", "work_precision.models=[\"constraints\"]"}),
                               figure_of("speed-accuracy", {by_evaluations, "work_precision.least_error=1e-5"})}) {
        const auto text = figure.resolved();
        EXPECT_EQ(read_figure({"x", "x.toml", text}, {}).resolved(), text);
    }
    EXPECT_NE(second({"work_precision.duration_s=2"}).resolved_work(), second().resolved_work());
    EXPECT_NE(second().resolved_work(), second({}, "time").resolved_work());
}

TEST(WorkPrecision, IsOfSmoothMotions) {
    expect_refused({"joints with joint_coulomb_N_m stick"},
                   [] { figure_of("speed-accuracy", {"work_precision.scene=\"measured\""}); });
}

}  // namespace doppel::work_precision_test
