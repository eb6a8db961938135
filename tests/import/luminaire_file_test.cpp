// Photometric files: what is read agrees with what the file says, and bad files are refused with their line.

#include "import/photometry/luminaire_file.h"
#include "import/base/import_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

namespace alvor {
namespace {

using std::numbers::pi;

/// What an IES file of a test says. Intensities are `intensity(vertical, horizontal)`, degrees.
struct Ies {
  std::string head = "IESNA:LM-63-2002\n";
  std::string tilt = "TILT=NONE\n";
  std::string lamps = "1 -1 1";
  int type = 1;
  std::string units_and_size = "2 0 0 0";
  std::string factors = "1 1 10";
  std::vector<double> vertical{0, 30, 60, 90}, horizontal{0};
  std::function<double(double, double)> intensity = [](double v, double) { return 100 * std::cos(v * pi / 180); };

  std::string text() const {
    std::ostringstream out;
    out.precision(12);
    out << head << tilt << lamps << ' ' << vertical.size() << ' ' << horizontal.size() << ' ' << type << ' ' << units_and_size
        << '\n'
        << factors << '\n';
    for (const double v : vertical) out << v << ' ';
    for (const double h : horizontal) out << h << ' ';
    for (const double h : horizontal) {
      out << '\n';
      for (const double v : vertical) out << intensity(v, h) << ' ';
    }
    return out.str() + "\n";
  }
  LuminaireFile read() const { return read_luminaire(text(), ".ies"); }
};

/// Returns the direction at these angles in the coordinates of PhotometricWeb::intensity, for type C.
Vec3 direction_c(double gamma, double c) {
  const double g = gamma * pi / 180, p = c * pi / 180;
  return {std::sin(g) * std::cos(p), std::sin(g) * std::sin(p), std::cos(g)};
}

std::vector<double> steps(double first, double last, int count) {
  std::vector<double> list;
  for (int n = 0; n <= count; ++n) list.push_back(first + (last - first) * n / count);
  return list;
}

/// Returns the error of reading `text` as .ies.
std::string fault(const std::string& text, const std::string& extension = ".ies") {
  try {
    read_luminaire(text, extension);
  } catch (const ImportError& error) {
    return error.what();
  }
  return "none";
}

TEST(IesFile, OfALambertianSourceHasPiTimesItsIntensity) {
  Ies ies;
  ies.vertical = steps(0, 90, 90);
  EXPECT_NEAR(ies.read().lumens, 100 * pi, 0.02);
  EXPECT_EQ(ies.read().symmetry, "axial");
}

TEST(IesFile, OfAnIsotropicSourceHasFourPiTimesItsIntensityExactly) {
  Ies ies;
  ies.vertical = steps(0, 180, 6);
  ies.intensity = [](double, double) { return 10.0; };
  EXPECT_NEAR(ies.read().lumens, 40 * pi, 1e-4);
}

TEST(IesFile, FactorsMultiplyTheIntensities) {
  Ies ies;
  ies.lamps = "2 1000 3";
  ies.factors = "0.9 0.5 40";
  EXPECT_NEAR(ies.read().web->greatest(), 100 * 3 * 0.9, 1e-3);  // the third factor is reserved since 2002
  EXPECT_NEAR(*ies.read().lamp_lumens, 2 * 1000 * 0.9, 1e-9);    // the multiplier is for candelas
  ies.head = "IESNA:LM-63-1995\n";
  EXPECT_NEAR(ies.read().web->greatest(), 100 * 3 * 0.9 * 0.5, 1e-3);
  EXPECT_EQ(ies.read().watts, 40);
}

TEST(IesFile, AbsolutePhotometryStatesNoLumensOfLamps) { EXPECT_FALSE(Ies().read().lamp_lumens); }

TEST(IesFile, EditionsAreToldByTheirFirstLine) {
  for (const auto& [head, edition] : {std::pair<std::string, std::string>{"IESNA91\n", "LM-63-1991"},
                                      {"IESNA:LM-63-1995\r\n[TEST] x\r\n[MORE] y\r\n", "LM-63-1995"},
                                      {"IES:LM-63-2019\n[OTHER\n]] [\n", "LM-63-2019"},
                                      {"a lamp of 1987\nof some maker\n", "LM-63-1986"},
                                      {"\xef\xbb\xbfjunk\n\nIESNA:LM-63-2002\n", "LM-63-2002"}}) {
    Ies ies;
    ies.head = head;
    EXPECT_EQ(ies.read().format, edition);
    EXPECT_NEAR(ies.read().web->greatest(), 100, 1e-4);
  }
}

/// Symmetries of type C: the planes of the file, and an intensity that has the symmetry.
struct Planes {
  const char* name;
  double first, last;
  double (*shape)(double);  // of the angle C, degrees
};
double cosine_of(double degrees) { return std::cos(degrees * pi / 180); }
const Planes all_symmetries[]{{"quadrant", 0, 90, [](double c) { return 2 + cosine_of(2 * c); }},
                              {"bilateral", 0, 180, [](double c) { return 2 + cosine_of(c); }},
                              {"bilateral", 90, 270, [](double c) { return 2 + std::sin(c * pi / 180); }},
                              {"none", 0, 360, [](double c) { return 2 + cosine_of(c - 45); }},
                              {"none", 0, 350, [](double c) { return 2 + cosine_of(c - 45); }}};
class IesSymmetry : public testing::TestWithParam<Planes> {};
INSTANTIATE_TEST_SUITE_P(Planes, IesSymmetry, testing::ValuesIn(all_symmetries), [](const auto& planes) {
  return planes.param.name + std::to_string(std::lround(planes.param.first)) + "To" +
         std::to_string(std::lround(planes.param.last));
});

TEST_P(IesSymmetry, IsCompletedAllAround) {
  const Planes& planes = GetParam();
  Ies ies;
  ies.horizontal = steps(planes.first, planes.last, static_cast<int>(std::lround(planes.last - planes.first)) / 10);
  ies.vertical = steps(0, 90, 18);
  ies.intensity = [&](double v, double h) { return cosine_of(v) * planes.shape(h); };
  const LuminaireFile file = ies.read();
  EXPECT_EQ(file.symmetry, planes.name);
  for (int c = 0; c < 360; c += 10)
    for (int gamma = 5; gamma < 90; gamma += 5)
      EXPECT_NEAR(file.web->intensity(direction_c(gamma, c)), cosine_of(gamma) * planes.shape(c), 1e-5) << c << ' ' << gamma;
}

TEST(IesFile, OddSpacingIsInterpolatedInTheAngles) {
  Ies ies;
  ies.vertical = {0, 2, 45, 46.5, 90};
  ies.intensity = [](double v, double) { return 10 + v; };
  for (const double gamma : {1.0, 20.0, 45.7, 80.0})
    EXPECT_NEAR(ies.read().web->intensity(direction_c(gamma, 77)), 10 + gamma, 1e-4);
  EXPECT_EQ(ies.read().web->intensity(direction_c(100, 0)), 0);
}

// Type B, LM-63-2002 section 3: the planes share a horizontal axis; V = 90 is that axis, H turns about it, clockwise.
TEST(IesFile, OfTypeBHasPlanesAboutTheHorizontalAxis) {
  Ies ies;
  ies.type = 2;
  ies.vertical = steps(-90, 90, 18), ies.horizontal = steps(-90, 90, 18);
  ies.intensity = [](double v, double h) { return 200 + v + 0.5 * h; };
  const LuminaireFile file = ies.read();
  EXPECT_EQ(file.type, 'B');
  for (const double v : {-60.0, 0.0, 35.0})
    for (const double h : {-80.0, 0.0, 30.0}) {
      const double sv = std::sin(v * pi / 180), cv = cosine_of(v), sh = std::sin(h * pi / 180), ch = cosine_of(h);
      EXPECT_NEAR(file.web->intensity({sv, -cv * sh, cv * ch}), 200 + v + 0.5 * h, 1e-3) << v << ' ' << h;
    }
  EXPECT_EQ(file.web->intensity({0, 0, -1}), 0);
}

TEST(IesFile, OfTypesAAndBMayStateAQuarter) {
  Ies ies;
  ies.type = 3;
  ies.vertical = steps(0, 90, 18), ies.horizontal = steps(0, 90, 18);
  ies.intensity = [](double v, double h) { return 200 + v + 0.5 * h; };
  const LuminaireFile file = ies.read();
  EXPECT_EQ(file.symmetry, "quadrant");
  const Vec3 direction = normalized(Vec3{0.3, 0.2, 0.8});
  for (const Vec3 mirrored : {Vec3{-0.3, 0.2, 0.8}, Vec3{0.3, -0.2, 0.8}, Vec3{-0.3, -0.2, 0.8}})
    EXPECT_NEAR(file.web->intensity(direction), file.web->intensity(normalized(mirrored)), 1e-4);
}

TEST(IesFile, NegativeSizesAreRoundOpenings) {
  using Shape = LuminousOpening::Shape;
  const auto opening = [](const char* units_and_size) {
    Ies ies;
    ies.units_and_size = units_and_size;
    return ies.read().opening;
  };
  EXPECT_EQ(opening("2 0 0 0"), LuminousOpening{});
  EXPECT_EQ(opening("2 0.6 1.2 0"), (LuminousOpening{Shape::rectangle, 1.2, 0.6, 0}));  // length lies along C0
  EXPECT_NEAR(opening("1 1 2 0").across, 0.6096, 1e-9);                                 // feet
  EXPECT_EQ(opening("2 -0.2 -0.2 0"), (LuminousOpening{Shape::ellipse, 0.2, 0.2, 0}));
  EXPECT_EQ(opening("2 -0.2 0 0"), (LuminousOpening{Shape::ellipse, 0.2, 0.2, 0}));  // as in 1995
  EXPECT_EQ(opening("2 0.3 0.4 0.1"), (LuminousOpening{Shape::box, 0.4, 0.3, 0.1}));
  EXPECT_EQ(opening("2 -0.3 -0.3 0.1"), (LuminousOpening{Shape::cylinder, 0.3, 0.3, 0.1}));
  EXPECT_EQ(opening("2 -0.3 -0.3 -0.3"), (LuminousOpening{Shape::sphere, 0.3, 0.3, 0.3}));
}

TEST(IesFile, TiltOfTheLampsIsReadAndTold) {
  Ies ies;
  ies.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n0.9 1 1.1\n";
  EXPECT_NEAR(ies.read().web->greatest(), 90, 1e-4);
  EXPECT_EQ(ies.read().warnings.size(), 1u);
  ies.tilt = "TILT=lamp.tlt\n";
  EXPECT_NEAR(ies.read().web->greatest(), 100, 1e-4);
  EXPECT_EQ(ies.read().warnings.size(), 1u);
}

TEST(IesFile, FaultsNameTheLine) {
  EXPECT_EQ(fault("hello\n"), "file: is not a luminaire: it has no line TILT=");
  EXPECT_EQ(fault(""), "file: is not a luminaire: it has no line TILT=");
  Ies ies;
  const std::string text = ies.text();
  EXPECT_EQ(fault(text.substr(0, text.size() - 22)), "line 6: the file ends before its intensities");
  ies.lamps = "1 -1 x";
  EXPECT_EQ(fault(ies.text()), "line 3: 'x' is not a number, needs its multiplier");
  ies.lamps = "1 -1 1e999";
  EXPECT_EQ(fault(ies.text()), "line 3: '1e999' is not a number, needs its multiplier");
  ies = {};
  ies.intensity = [](double, double) { return -1.0; };
  EXPECT_EQ(fault(ies.text()), "line 6: an intensity is negative");
  ies.intensity = [](double, double) { return 0.0; };
  EXPECT_EQ(fault(ies.text()), "file: the luminaire brings no light: all intensities are 0");
  ies = {};
  ies.vertical = {0, 60, 30};
  EXPECT_EQ(fault(ies.text()), "file: the angles of its photometric web do not ascend");
  ies = {};
  ies.horizontal = {0, 60, 120};
  EXPECT_EQ(fault(ies.text()).substr(0, 27), "horizontal angles: go from ");
  EXPECT_EQ(fault("IESNA91\nTILT=NONE\n1 1 1 1000000 1000000 1 1 0 0 0\n"),
            "line 3: its number of vertical angles is not a whole number in [2, 10000]");
  EXPECT_EQ(fault("IESNA91\nTILT=NONE\n1 1 1 9000 9000 1 1 0 0 0\n"), "line 3: has more than 200000 intensities");
}

std::string eulumdat(int symmetry, const std::vector<double>& planes, const std::vector<double>& angles, std::size_t first,
                     std::size_t count, const std::function<double(double, double)>& intensity, double output_percent) {
  std::ostringstream out;
  out << "maker\r\n2\r\n" << symmetry << "\r\n" << planes.size() << "\r\n0\r\n" << angles.size() << "\r\n0\r\nreport\r\nname\r\n";
  out << "no\r\nfile\r\ndate\r\n1000\r\n200\r\n50\r\n900\r\n150\r\n0\r\n0\r\n0\r\n0\r\n100\r\n" << output_percent;
  out << "\r\n1,0\r\n0\r\n1\r\n1\r\nLED\r\n2000\r\nwhite\r\n1A\r\n20,5\r\n";
  for (int n = 0; n < 10; ++n) out << "0.5\r\n";
  for (const double c : planes) out << c << "\r\n";
  for (const double g : angles) out << g << "\r\n";
  for (std::size_t n = 0; n < count; ++n)
    for (const double g : angles) out << intensity(g, planes[(first + n) % planes.size()]) << "\r\n";
  return out.str();
}

TEST(EulumdatFile, SymmetriesAreCompletedAllAround) {
  std::vector<double> planes;
  for (int c = 0; c < 360; c += 15) planes.push_back(c);
  const std::vector<double> angles = steps(0, 90, 18);
  struct Case {
    int symmetry;
    std::size_t first, count;
    double (*shape)(double);
  };
  for (const Case& c : {Case{0, 0, 24, [](double a) { return 2 + cosine_of(a - 45); }}, Case{1, 0, 1, [](double) { return 2.0; }},
                        Case{2, 0, 13, [](double a) { return 2 + cosine_of(a); }},
                        Case{3, 18, 13, [](double a) { return 2 + std::sin(a * pi / 180); }},
                        Case{4, 0, 7, [](double a) { return 2 + cosine_of(2 * a); }}}) {
    const auto intensity = [&](double g, double plane) { return 100 * cosine_of(g) * c.shape(plane); };
    const LuminaireFile file = read_luminaire(eulumdat(c.symmetry, planes, angles, c.first, c.count, intensity, 62.83), ".ldt");
    for (const double plane : planes)
      for (const double g : {10.0, 45.0, 80.0})  // cd per 1000 lm of 2000 lm
        EXPECT_NEAR(file.web->intensity(direction_c(g, plane)), 2 * intensity(g, plane), 0.02) << c.symmetry << ' ' << plane;
    EXPECT_NEAR(file.lumens, 2 * pi * 2 * 100, 1);
    EXPECT_EQ(file.watts, 20.5);
    EXPECT_EQ(file.opening, (LuminousOpening{LuminousOpening::Shape::rectangle, 0.15, 0.9, 0}));
    EXPECT_TRUE(file.warnings.empty());
  }
}

TEST(EulumdatFile, LumensThatDifferFromItsStatementAreTold) {
  const auto intensity = [](double g, double) { return 200 * cosine_of(g); };
  const std::string text = eulumdat(1, {0, 90}, steps(0, 90, 18), 0, 1, intensity, 50);
  const LuminaireFile file = read_luminaire(text, ".ldt");
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_EQ(file.warnings[0], "its intensities add up to 1255.8 lm, +25.6 % of the 1000 lm that it states");
  EXPECT_EQ(fault(text.substr(0, 60), ".ldt").substr(0, 5), "line ");
  EXPECT_EQ(fault(Ies().text(), ".ldt").substr(0, 7), "line 2:");
}

TEST(LuminaireFiles, OfTheScenesFolderAreSound) {
  for (const char* name : {"panel.ies", "downlight.ies", "pendant.ldt"}) {
    std::ifstream stream(std::string(ALVOR_SCENES) + "/luminaires/" + name, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    const LuminaireFile file = read_luminaire(bytes, std::string(name).substr(std::string(name).size() - 4));
    EXPECT_TRUE(file.warnings.empty()) << name << ": " << (file.warnings.empty() ? "" : file.warnings[0]);
    EXPECT_GT(file.lumens, 500) << name;
  }
}

}  // namespace
}  // namespace alvor
