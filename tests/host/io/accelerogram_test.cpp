// SPDX-License-Identifier: MIT
#include <cmath>

#include "files.h"
#include "topple/input.h"

namespace topple {
namespace {

using test::expect_input_error;

class Accelerograms : public test::Files {
  protected:
    Accelerogram read(std::string_view bytes, std::optional<double> unit = {}) {
        return read_accelerogram(write("record", bytes), unit);
    }
    template <class Bad>
    void refused(const Bad& files) {
        expect_refused("record", files, [](const auto& file) { read_accelerogram(file); });
    }
};

TEST_F(Accelerograms, JsonAsSimulationToolsWriteIt) {
    const Accelerogram plain =
        read(R"({"name": "a", "numPoints": 3, "dT": 0.02, "accel_data": [0, -0.5, 0.25]})");
    EXPECT_EQ(plain.step_s, 0.02);
    EXPECT_EQ(plain.m_s2, (std::vector<double>{0, -0.5 * 9.80665, 0.25 * 9.80665}));
    EXPECT_DOUBLE_EQ(plain.peak_m_s2(), 0.5 * 9.80665);
    EXPECT_DOUBLE_EQ(plain.duration_s(), 0.04);
    ASSERT_EQ(plain.notes.size(), 1u);
    EXPECT_THAT(plain.notes[0], testing::HasSubstr("in g"));

    const Accelerogram nested = read(
        R"({"timeSeries": [{"dt": 0.01, "data": [1, 2], "factor": 2, "units": "m/s^2"}], "x": 1})");
    EXPECT_EQ(nested.m_s2, (std::vector<double>{2, 4}));
    EXPECT_TRUE(nested.notes.empty());
}

TEST_F(Accelerograms, ComponentsOfOneRecordBeginTogether) {
    const auto along = write("along", "# m/s2\n0 1\n0.01 2\n0.02 3\n");
    const auto across = write("across", "# m/s2\n0 4\n0.01 5\n");
    const auto up = write("up", "# m/s2\n0 6\n0.01 7\n0.02 8\n0.03 9\n");
    const auto slow = write("slow", "# m/s2\n0 6\n0.02 7\n");
    const Accelerogram record = read_accelerogram(along, across, up);
    EXPECT_EQ(record.m_s2, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(record.across_m_s2, (std::vector<double>{4, 5, 0})) << "shorter";
    EXPECT_EQ(record.up_m_s2, (std::vector<double>{6, 7, 8})) << "longer";
    EXPECT_DOUBLE_EQ(record.peak_m_s2(), std::sqrt(15.0));
    EXPECT_TRUE(read_accelerogram(along, {}, up).across_m_s2.empty());
    EXPECT_TRUE(read_accelerogram(along, std::nullopt, std::nullopt).up_m_s2.empty());
    EXPECT_EQ(read_accelerogram(along, across, {}, 0.5).across_m_s2[0], 2);
    expect_input_error([&] { read_accelerogram(along, {}, slow); },
                       {slow.native(), along.native(), "components of one record"});
}

TEST_F(Accelerograms, UnitsOfTheHeaderAndOfTheOption) {
    const std::string rows = "0 0.1\n0.01 -0.2\n0.02 0\n";
    for (const auto& [header, scale] :
         std::vector<std::pair<std::string, double>>{{"# time s, acceleration m/s^2\n", 1},
                                                     {"Time (sec), Acc. (cm/s2)\n", 0.01},
                                                     {"t_s\ta_g\n", 9.80665},
                                                     {"station X\n# units: gal\n", 0.01},
                                                     {"\xEF\xBB\xBF% [M/S2]\n", 1}}) {
        const Accelerogram record = read(header + rows);
        ASSERT_EQ(record.m_s2.size(), 3u) << header;
        EXPECT_DOUBLE_EQ(record.m_s2[1], -0.2 * scale) << header;
        EXPECT_NEAR(record.step_s, 0.01, 1e-15);
        EXPECT_TRUE(record.notes.empty());
        EXPECT_DOUBLE_EQ(read(header + rows, 0.5).m_s2[1], -0.1) << "the option wins";
    }
    EXPECT_EQ(read(rows).notes.size(), 1u);
    EXPECT_DOUBLE_EQ(read(rows).m_s2[0], 0.980665);
    refused(std::vector<test::BadFile>{
        {"# cm/s2, 1 g = 980.665 cm/s2\n" + rows, {"several units", "acceleration_unit_m_s2()"}}});
    EXPECT_EQ(read("# cm/s2, not g\n" + rows, 0.01).notes.size(), 0u);
}

TEST_F(Accelerograms, TextWithFewDigitsOrMoreColumns) {
    const Accelerogram coarse = read("0.00 1 9\n0.01,0.5,9\n0.01667;0;9\n0.03 0 9\r\n\n", 1.0);
    EXPECT_EQ(coarse.m_s2, (std::vector<double>{1, 0.5, 0, 0}));
    EXPECT_DOUBLE_EQ(coarse.step_s, 0.01);
}

TEST_F(Accelerograms, PeersRecordsInBothForms) {
    const Accelerogram now = read(
        "PEER NGA STRONG MOTION DATABASE RECORD\n"
        "Nowhere-01, 1/2/2003, Station #5, 140\n"
        "ACCELERATION TIME SERIES IN UNITS OF G\n"
        "NPTS=      7, DT=   .0050 SEC,\n"
        "  .1000000E-02  -.2000000E-02   .3000000E-02   0   .5\r\n"
        "  1.0E-01 -0.25\n");
    EXPECT_EQ(now.step_s, 0.005);
    ASSERT_EQ(now.m_s2.size(), 7u);
    EXPECT_DOUBLE_EQ(now.m_s2[1], -0.002 * 9.80665);
    EXPECT_DOUBLE_EQ(now.m_s2[6], -0.25 * 9.80665);
    EXPECT_TRUE(now.notes.empty());
    const Accelerogram before = read(
        "PACIFIC ENGINEERING AND ANALYSIS STRONG-MOTION DATA\n"
        "NOWHERE 01/02/03, STATION, 140\n"
        "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz\n"
        "    3    0.0100    NPTS, DT\n"
        " 0.1 0.2\n 0.3\n");
    EXPECT_EQ(before.step_s, 0.01);
    EXPECT_DOUBLE_EQ(before.m_s2[2], 0.3 * 9.80665);
    EXPECT_DOUBLE_EQ(read("NPTS=2, DT=.01\n1 2\n", 1.0).m_s2[1], 2) << "the option's unit";
    EXPECT_EQ(read("NPTS=2, DT=.01\n1 2\n").notes.size(), 1u) << "no unit";

    const test::BadFile cases[] = {
        {"IN UNITS OF G\nNPTS= 3, DT= .01\n0.1 0.2\n", {"NPTS 3", "2 samples", "cut short"}},
        {"IN UNITS OF G\nNPTS= 1, DT= .01\n0.1 0.2\n", {"line 3", "more samples", "1"}},
        {"IN UNITS OF G\nNPTS= 2, DT= .01\n0.1 x\n", {"line 3", "\"x\"", "not a number"}},
        {"IN UNITS OF G\nNPTS= 2, DT= .01\n0.1 inf\n", {"line 3", "finite"}},
        {"IN UNITS OF G\nNPTS= -2, DT= .01\n", {"line 2", "NPTS is -2"}},
        {"IN UNITS OF G\nNPTS= 1e30, DT= .01\n1\n", {"NPTS is 1e+30"}},
        {"IN UNITS OF G\nNPTS= 2, DT= 5\n1 2\n", {"5 s apart"}},
        {"IN UNITS OF CM/S2\nIN UNITS OF G\nNPTS= 2, DT= .01\n1 2\n", {"several units"}},
    };
    refused(cases);
}

TEST_F(Accelerograms, FaultsAreNamedWithTheirPlaceAndMend) {
    std::string endless = "{\"dT\": 0.5, \"accel_data\": [1";
    for (int n = 0; n < 7300; ++n) endless += ",0";
    const test::BadFile cases[] = {
        {"", {"empty"}},
        {"hello\n", {"0 samples"}},
        {"0 0.1\n", {"1 sample", "2"}},
        {"0 0.1\n0.01 nan\n", {"line 2", "nan", "finite"}},
        {"0 0.1\n0.01 x\n", {"line 2", "\"x\""}},
        {"0 0.1\n\n0.01\n", {"line 3", "one value"}},
        {"0 0.1\n0.02 0.1\n0.02 0.3\n", {"line 3", "0.02", "rise"}},
        {"0 0.1\n0.01 0.1\n0.02 0.3\n0.09 0.1\n0.1 0\n", {"line 4", "0.09", "0.07 s", "equally"}},
        {"0 0\n0.01 0\n", {"no acceleration"}},
        {"0 0.1\n10 0\n", {"10 s apart", "0.5 s", "seconds"}},
        {"# gal\n0 20000\n0.01 0\n", {"20.39", "limit of 10 g", "acceleration_unit_m_s2()"}},
        {"0 3.13\n0.01 0\n", {"3.13 g", "no unit", "limit of 3 g", "m/s2"}},
        {std::string("0 1\0 1", 6), {"neither JSON nor text"}},
        {"{\"dT\": 0.1", {"no JSON"}},
        {"[1, 2]", {"object", "array"}},
        {R"({"accel_data": [1, 2]})", {"no \"dT\"", "seconds"}},
        {R"({"dT": "x", "accel_data": [1, 2]})", {"\"dT\"", "number", "string"}},
        {R"({"dT": 0.1})", {"no \"accel_data\"", "list"}},
        {R"({"dT": 0.1, "accel_data": 3})", {"\"accel_data\"", "list", "number"}},
        {R"({"dT": 0.1, "accel_data": [1, null]})", {"\"accel_data\"[1]", "null"}},
        {R"({"dT": 0, "accel_data": [1, 2]})", {"0 s apart"}},
        {R"({"dT": -0.1, "accel_data": [1, 2]})", {"-0.1 s apart"}},
        {R"({"dT": 0.1, "numPoints": 3, "accel_data": [1, 2]})", {"3", "2 numbers"}},
        {R"({"dT": 0.1, "accel_data": [1, 2], "unit": "ft"})", {"\"ft\"", "m/s^2"}},
        {R"({"timeSeries": [{}, {}]})", {"one record"}},
        {endless + "]}", {"3650 s", "3600 s"}},
    };
    refused(cases);
    EXPECT_EQ(read("0 3.13\n0.01 0\n", 1.0).m_s2[0], 3.13);
}

}  // namespace
}  // namespace topple
