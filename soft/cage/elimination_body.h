// SPDX-License-Identifier: AGPL-3.0-or-later
// Elimination in a dense front, part of kernels_body.h. Each entry's sum runs over the eliminated
// columns in the same order whatever the registers' width, in pieces that the front's size alone
// decides.

using V = double __attribute__((vector_size(kRegister)));

constexpr std::size_t kPerRegister = kRegister / sizeof(double);
constexpr std::size_t kTileRows = 2 * kPerRegister;
constexpr std::size_t kTileColumns = kTileRows < 8 ? kTileRows : kTileRows / 2;
constexpr std::size_t kFewColumns = 8;  // that are eliminated one by one

inline V load(const double* p) noexcept {
  V a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
inline void store(V a, double* p) noexcept {
  __builtin_memcpy(p, &a, sizeof a);
}

struct Front {
  double* entries;  // (n, n), row fastest
  std::size_t n;
  double* packed;
};

// Columns k to k + depth of the rows from `first`, in groups of rows that one tile takes, column
// after column in each; rows beyond the last are zero.
inline void pack(const Front& f, std::size_t first, std::size_t k, std::size_t depth) noexcept {
  double* to = f.packed;
  for (std::size_t i = first; i < f.n; i += kTileRows) {
    const std::size_t m = f.n - i < kTileRows ? f.n - i : kTileRows;
    for (std::size_t d = 0; d < depth; ++d, to += kTileRows) {
      const double* from = f.entries + (k + d) * f.n + i;
      for (std::size_t r = 0; r < m; ++r) to[r] = from[r];
      for (std::size_t r = m; r < kTileRows; ++r) to[r] = 0;
    }
  }
}

// out (kTileRows, kTileColumns) = rows (kTileRows, depth) times columns (kTileColumns, depth)^T, of
// groups that pack made.
inline void multiply_tile(const double* rows, const double* columns, std::size_t depth,
                          V (&out)[kTileColumns][2]) noexcept {
  V sum[kTileColumns][2] = {};
  for (std::size_t d = 0; d < depth; ++d, rows += kTileRows, columns += kTileRows) {
    const V low = load(rows);
    const V high = load(rows + kPerRegister);
#pragma GCC unroll 8
    for (std::size_t c = 0; c < kTileColumns; ++c) {
      sum[c][0] += low * columns[c];
      sum[c][1] += high * columns[c];
    }
  }
#pragma GCC unroll 8
  for (std::size_t c = 0; c < kTileColumns; ++c) {
    out[c][0] = sum[c][0];
    out[c][1] = sum[c][1];
  }
}

// entries (m rows, columns) -= tile; what lies beyond either is not written.
inline void subtract_tile(const V (&tile)[kTileColumns][2], double* entries, std::size_t stride,
                          std::size_t m, std::size_t columns) noexcept {
  for (std::size_t c = 0; c < kTileColumns && c < columns; ++c) {
    double* to = entries + c * stride;
    if (m >= kTileRows) {
      store(load(to) - tile[c][0], to);
      store(load(to + kPerRegister) - tile[c][1], to + kPerRegister);
      continue;
    }
    double value[kTileRows];
    store(tile[c][0], value);
    store(tile[c][1], value + kPerRegister);
    for (std::size_t r = 0; r < m; ++r) to[r] -= value[r];
  }
}

// Takes what columns k to `k_end` stand for from the entries below the diagonal of columns `first`
// to `end`. Entries above the diagonal that share a tile with it change, too.
void subtract_eliminated(const Front& f, std::size_t first, std::size_t end, std::size_t k,
                         std::size_t k_end) noexcept {
  for (; k < k_end; k += kEliminationDepth) {
    const std::size_t depth = k_end - k < kEliminationDepth ? k_end - k : kEliminationDepth;
    pack(f, first, k, depth);
    for (std::size_t j = first; j < end; j += kTileColumns) {
      const std::size_t group = (j - first) / kTileRows;
      const double* columns = f.packed + group * kTileRows * depth + (j - first) % kTileRows;
      const double* rows = f.packed + group * kTileRows * depth;
      for (std::size_t i = first + group * kTileRows; i < f.n; i += kTileRows) {
        V tile[kTileColumns][2];
        multiply_tile(rows, columns, depth, tile);
        subtract_tile(tile, f.entries + j * f.n + i, f.n, f.n - i, end - j);
        rows += kTileRows * depth;
      }
    }
  }
}

bool eliminate_few(const Front& f, std::size_t first, std::size_t end) noexcept {
  for (std::size_t j = first; j < end; ++j) {
    double* const __restrict column = f.entries + j * f.n;
    if (!(column[j] > 0)) return false;
    const double pivot = __builtin_sqrt(column[j]);
    column[j] = pivot;
    for (std::size_t r = j + 1; r < f.n; ++r) column[r] /= pivot;
    for (std::size_t i = j + 1; i < end; ++i) {
      double* const __restrict next = f.entries + i * f.n;
      const double share = column[i];
      for (std::size_t r = i; r < f.n; ++r) next[r] -= column[r] * share;
    }
  }
  return true;
}

// By halves: the first, what it stands for in the second, the second.
bool eliminate_columns(const Front& f, std::size_t first, std::size_t end) noexcept {
  if (end - first <= kFewColumns) return eliminate_few(f, first, end);
  const std::size_t half = (end - first + 1) / 2;
  const std::size_t middle = first + (half + kFewColumns - 1) / kFewColumns * kFewColumns;
  if (!eliminate_columns(f, first, middle)) return false;
  subtract_eliminated(f, middle, end, first, middle);
  return eliminate_columns(f, middle, end);
}

bool eliminate(double* entries, std::size_t n, std::size_t columns, double* packed) {
  const Front f{entries, n, packed};
  if (!eliminate_columns(f, 0, columns)) return false;
  subtract_eliminated(f, columns, n, 0, columns);
  return true;
}
