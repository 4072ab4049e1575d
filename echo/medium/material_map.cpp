// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/material_map.h"

#include "artus/detail/core/check.h"
#include "artus/detail/echo/medium/simd.h"

namespace artus {
namespace {

/// How each term comes from an earlier one: times one coordinate.
struct Term {
  std::array<int, 3> power{};
  std::size_t parent = 0;
  std::size_t axis = 0;
};

using TermList = std::array<Term, MaterialMap::kTerms>;

/// The index of x^i y^j z^k; kTerms when there is none.
constexpr std::size_t find_power(const TermList& terms, const std::array<int, 3>& power) {
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (terms[k].power == power) return k;
  }
  return terms.size();
}

constexpr Term make_term(const TermList& before, const std::array<int, 3>& power) {
  Term term;
  term.power = power;
  term.axis = power[0] > 0 ? 0 : (power[1] > 0 ? 1 : 2);
  std::array<int, 3> parent = power;
  if (parent[term.axis] == 0) return term;  // the constant
  --parent[term.axis];
  term.parent = find_power(before, parent);
  return term;
}

constexpr TermList make_terms() {
  TermList terms{};
  std::size_t n = 0;
  for (int degree = 0; degree <= MaterialMap::kDegree; ++degree) {
    for (int i = degree; i >= 0; --i) {
      for (int j = degree - i; j >= 0; --j) {
        terms[n] = make_term(terms, {i, j, degree - i - j});
        ++n;
      }
    }
  }
  return terms;
}

constexpr auto kTermList = make_terms();

constexpr std::size_t find_term(const std::array<int, 3>& power) {
  return find_power(kTermList, power);
}

constexpr std::size_t kColumns = MaterialMap::kColumns;

/// out = the sum of the table's rows of kColumns, each times its term.
ARTUS_SIMD
void sum_terms(const float* terms, const float* table, float* out, std::size_t n_terms) noexcept {
  std::array<float, kColumns> sum{};
  for (std::size_t k = 0; k < n_terms; ++k) {
    for (std::size_t c = 0; c < kColumns; ++c) sum[c] += terms[k] * table[k * kColumns + c];
  }
  for (std::size_t c = 0; c < kColumns; ++c) out[c] = sum[c];
}

}  // namespace

MaterialMap::MaterialMap(const Vec3& centre_J, double scale, const Coefficients& coefficients)
    : centre_(centre_J), inverse_scale_(1 / scale) {
  ARTUS_REQUIRE(scale > 0 && coefficients.allFinite(), "the map must be finite");
  for (std::size_t k = 0; k < kTerms; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = coefficients(static_cast<int>(k), static_cast<int>(c));
      table_[k][c] = static_cast<float>(value);
      for (std::size_t a = 0; a < 3; ++a) {  // the slope by axis a has a term of one degree less
        std::array<int, 3> power = kTermList[k].power;
        if (power[a] == 0) continue;
        const int factor = power[a]--;
        table_[find_term(power)][3 + 3 * c + a] +=
            static_cast<float>(factor * value * inverse_scale_);
      }
    }
  }
}

MaterialPoint MaterialMap::evaluate(const Vec3& p_J) const noexcept {
  const Eigen::Vector3f x = (inverse_scale_ * (p_J - centre_)).cast<float>();
  std::array<float, kTerms> terms{};
  terms[0] = 1;
  for (std::size_t k = 1; k < kTerms; ++k) {
    terms[k] = terms[kTermList[k].parent] * x[static_cast<Eigen::Index>(kTermList[k].axis)];
  }
  std::array<float, kColumns> out{};
  sum_terms(terms.data(), table_[0].data(), out.data(), kTerms);
  MaterialPoint point;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    point.place[row] = out[c];
    for (std::size_t a = 0; a < 3; ++a) {
      point.gradient(row, static_cast<Eigen::Index>(a)) = out[3 + 3 * c + a];
    }
  }
  return point;
}

MaterialMap::Terms MaterialMap::terms(const Vec3& x) noexcept {
  Terms terms = Terms::Zero();
  terms[0] = 1;
  for (std::size_t k = 1; k < kTerms; ++k) {
    terms[static_cast<Eigen::Index>(k)] = terms[static_cast<Eigen::Index>(kTermList[k].parent)] *
                                          x[static_cast<Eigen::Index>(kTermList[k].axis)];
  }
  return terms;
}

MaterialMap::Slopes MaterialMap::slopes(const Vec3& x) noexcept {
  const Terms values = terms(x);
  Slopes slopes = Slopes::Zero();
  for (std::size_t k = 1; k < kTerms; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<int, 3> power = kTermList[k].power;
      if (power[a] == 0) continue;
      const int factor = power[a]--;
      slopes(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(k)) =
          factor * values[static_cast<Eigen::Index>(find_term(power))];
    }
  }
  return slopes;
}

}  // namespace artus
