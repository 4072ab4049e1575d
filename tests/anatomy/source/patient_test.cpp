// SPDX-License-Identifier: AGPL-3.0-or-later
// Draws against closed forms: of a standard normal x clipped at 2, E x = 0 and
// E x^2 = (2 P(2) - 1) - 4 p(2) + 8 (1 - P(2)) = 0.92052, with the normal's density p and share P.
#include "artus/detail/anatomy/source/patient.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr int kDraws = 20000;
constexpr double kClippedVariance = 0.92052;

Population bundled() {
  return read_bundled_population().value();
}

double value_of(const std::vector<PatientValue>& values, const std::string& name) {
  for (const PatientValue& v : values)
    if (v.name == name) return v.value;
  throw std::runtime_error("no " + name);
}

/// Means of what a function says of each draw.
template <class Of>
double mean_of(const Population& population, const std::vector<PatientValue>& given, Of of) {
  double sum = 0;
  for (int seed = 0; seed < kDraws; ++seed)
    sum += of(draw_patient(population, static_cast<std::uint64_t>(seed), given));
  return sum / kDraws;
}

TEST(Patient, ADrawnThicknessHasItsPublishedMeanAndClippedSpread) {
  const Population population = bundled();
  for (const double sex : {0.0, 1.0}) {
    const double mean = sex == 0 ? 19.2 : 17.6;
    const double sd = sex == 0 ? 3.1 : 3.0;
    const std::vector<PatientValue> given{{"sex", sex}};
    const double error = sd / std::sqrt(kDraws);
    EXPECT_NEAR(mean_of(population, given, [](const auto& v) { return value_of(v, "muscle"); }),
                mean, 4 * error);
    const double variance = mean_of(population, given, [&](const auto& v) {
      return std::pow(value_of(v, "muscle") - mean, 2);
    });
    EXPECT_NEAR(variance, kClippedVariance * sd * sd,
                4 * sd * sd * std::sqrt(1.5 / kDraws));  // E x^4 of the clipped is below 1.5 + 1
  }
}

TEST(Patient, NothingIsDrawnBeyondTwoStandardDeviations) {
  const Population population = bundled();
  double least = 1e9;
  double most = -1e9;
  for (int seed = 0; seed < kDraws; ++seed) {
    const double fat =
        value_of(draw_patient(population, static_cast<std::uint64_t>(seed), {{"sex", 0}}), "fat");
    least = std::min(least, fat);
    most = std::max(most, fat);
  }
  EXPECT_DOUBLE_EQ(least, 2.4);  // 5.9 - 2 * 1.75
  EXPECT_DOUBLE_EQ(most, 9.4);
}

/// E of the product of two standard normals of correlation r, clipped at 2, by the midpoint rule.
double clipped_product(double r) {
  constexpr int kSteps = 400;
  constexpr double kFar = 8;
  const double step = 2 * kFar / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double x = -kFar + (i + 0.5) * step;
      const double e = -kFar + (j + 0.5) * step;
      const double y = r * x + std::sqrt(1 - r * r) * e;
      sum += std::clamp(x, -2.0, 2.0) * std::clamp(y, -2.0, 2.0) * std::exp(-(x * x + e * e) / 2) *
             step * step;
    }
  return sum / (2 * M_PI);
}

TEST(Patient, FatGoesAlongWithBodyMassAsPublished) {
  const Population population = bundled();
  const std::vector<PatientValue> given{{"sex", 0}};
  const double product = mean_of(population, given, [](const auto& v) {
    return (value_of(v, "fat") - 5.9) / 1.75 * (value_of(v, "bmi") - 26.5) / 4.0;
  });
  EXPECT_NEAR(product, clipped_product(0.65), 4 * std::sqrt(1.5 / kDraws));
  const double apart = mean_of(population, given, [](const auto& v) {
    return (value_of(v, "age") - 55) / 14 * (value_of(v, "bmi") - 26.5) / 4.0;
  });
  EXPECT_NEAR(apart, 0, 4 / std::sqrt(kDraws));
}

TEST(Patient, GivenABodyMassTheFatFollowsByItsRegression) {
  // z of the BMI is 2, so that of the fat is 1.3 +- 0.76, which is cut at 2: mean of
  // min(1.3 + 0.76 e, 2) = 1.3 - 0.76 (p(k) - k (1 - P(k))), k = 0.7 / 0.76
  const double s = std::sqrt(1 - 0.65 * 0.65);
  const double k = 0.7 / s;
  const double cut =
      s * (std::exp(-k * k / 2) / std::sqrt(2 * M_PI) - k * std::erfc(k / std::sqrt(2.0)) / 2);
  const double mean = mean_of(bundled(), {{"sex", 0}, {"bmi", 34.5}},
                              [](const auto& v) { return (value_of(v, "fat") - 5.9) / 1.75; });
  EXPECT_NEAR(mean, 1.3 - cut, 4 * s / std::sqrt(kDraws));
}

TEST(Patient, SharesOfBursaeAndTearsAreThoseOfTheTables) {
  const Population population = bundled();
  const auto share = [&](const std::vector<PatientValue>& given, const std::string& name,
                         double above) {
    return mean_of(population, given,
                   [&](const auto& v) { return value_of(v, name) > above ? 1.0 : 0.0; });
  };
  const auto error = [](double p) {
    return 4 * std::sqrt(p * (1 - p) / kDraws) + 1e-9;
  };
  // A drawn value is rounded to 0.01, so the edges of the published classes lie between two.
  EXPECT_NEAR(share({}, "bursa", 1.005), 129 / 200.0, error(0.6) + 0.003);
  EXPECT_NEAR(share({}, "bursa", 2.005), 47 / 200.0, error(0.2) + 0.003);
  EXPECT_NEAR(share({{"age", 65}}, "tear", 0.5), 0.057, error(0.057));
  EXPECT_NEAR(share({{"age", 75}}, "tear", 0.5), 0.15, error(0.15));
  EXPECT_EQ(share({{"age", 40}}, "tear", 0.5), 0);
  EXPECT_EQ(share({{"tear", 1}}, "effusion", 0.5), 0);  // the torn cuff's joint and bursa are one
}

TEST(Patient, ASeedGivesOneBodyWhateverElseIsInTheFile) {
  const Population population = bundled();
  Population fewer = population;
  fewer.quantities.erase(fewer.quantities.begin() + 5, fewer.quantities.end());
  const auto all = draw_patient(population, 7);
  const auto some = draw_patient(fewer, 7);
  EXPECT_EQ(to_text(all).rfind(to_text(some), 0), 0U);
  EXPECT_EQ(to_text(all), to_text(draw_patient(population, 7)));
  EXPECT_NE(to_text(all), to_text(draw_patient(population, 8)));
}

const std::vector<JointParameter>& fat_only() {
  static const std::vector<JointParameter> parameters{{"fat", "fat", "mm", 6, 1, 10}};
  return parameters;
}

TEST(Patient, AJointIsGivenWhatItHasAParameterForAndWhoItIs) {
  const auto values = resolve_patient("obese_m_bmi38", fat_only());
  ASSERT_TRUE(values) << values.error().to_string();
  EXPECT_EQ(to_text(*values), "sex=0,age=52,bmi=38,fat=10");  // 14.8 is more than it can take
}

TEST(Patient, WhatIsPrintedIsReadBackTheSame) {
  const auto drawn = resolve_patient("seed=7", fat_only());
  ASSERT_TRUE(drawn);
  const auto again = resolve_patient(to_text(*drawn), fat_only());
  ASSERT_TRUE(again) << again.error().to_string();
  EXPECT_EQ(to_text(*again), to_text(*drawn));
  EXPECT_EQ(to_text(resolve_patient("old_f_tear,fat=3", fat_only()).value()),
            "sex=1,age=74,bmi=25,fat=3");
}

TEST(Patient, AnUnknownNameIsToldWithWhatThereIs) {
  const std::map<std::string, std::string> refusals{
      {"fatt=3", "it has fat, sex, age, bmi"},
      {"muscle=20", "no parameter 'muscle'"},
      {"fat=11", "1 to 10 mm"},
      {"fat=thick", "not NAME=NUMBER"},
      {"fat=nan", "not NAME=NUMBER"},
      {"seed=1.5", "whole number"},
      {"obese", "obese_m_bmi38"},
      {"fat=3,", "patient"},
  };
  for (const auto& [text, message] : refusals) {
    const auto values = resolve_patient(text, fat_only());
    ASSERT_FALSE(values) << text;
    EXPECT_NE(values.error().to_string().find(message), std::string::npos)
        << text << ": " << values.error().to_string();
  }
}

TEST(Patient, AFileThatMakesNoSenseIsRefusedWithAllItsProblems) {
  const auto bad = parse_population(R"(format = 1
[[quantity]]
name = "fat"
title = "fat"
source = "assumed"
man = [5, 0]
woman = [5, 1]
along = { bmi = 0.5 }
[[quantity]]
name = "bursa"
title = "bursa"
source = "assumed"
quantiles = [[1, 0], [0.5, 1]]
[[profile]]
name = "x"
title = "x"
source = "assumed"
values = { fatt = 3 }
)",
                                    "here");
  ASSERT_FALSE(bad);
  const std::string told = bad.error().to_string();
  for (const char* part : {"sd above 0", "quantities above", "that ascend", "fatt"})
    EXPECT_NE(told.find(part), std::string::npos) << told;
}

}  // namespace
}  // namespace artus
