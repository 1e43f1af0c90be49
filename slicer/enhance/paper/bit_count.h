// SPDX-License-Identifier: GPL-3.0-or-later
// Counting in 64 columns at once: a number for each bit of a word, as bit planes, lowest first.
//
//   column          3 2 1 0
//   plane 0 (1s)    1 0 1 0
//   plane 1 (2s)    1 1 0 0      the numbers are 3, 2, 1, 0
//
// An addition is a row of full adders: a few operations on words for 64 sums.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace binderjet::bits {

template <std::size_t Planes>
using Number = std::array<std::uint64_t, Planes>;

// A bit and its two neighbors in the word: 0 to 3. Beyond the word's ends is 0.
inline Number<2> add_neighbors(std::uint64_t word) {
  const std::uint64_t left = word << 1;
  const std::uint64_t right = word >> 1;
  const std::uint64_t odd = left ^ right;
  return {odd ^ word, (left & right) | (odd & word)};
}

template <std::size_t Planes>
Number<Planes + 1> add(const Number<Planes>& a, const Number<Planes>& b) {
  Number<Planes + 1> sum;
  std::uint64_t carry = 0;
  for (std::size_t p = 0; p < Planes; ++p) {
    const std::uint64_t odd = a[p] ^ b[p];
    sum[p] = odd ^ carry;
    carry = (a[p] & b[p]) | (odd & carry);
  }
  sum[Planes] = carry;
  return sum;
}

// Three numbers of 0 to 3 give 0 to 9 in four planes.
inline Number<4> add3(const Number<2>& a, const Number<2>& b, const Number<2>& c) {
  const Number<3> ab = add(a, b);
  return add(ab, Number<3>{c[0], c[1], 0});
}

// Three numbers of 0 to 9 give 0 to 27 in five planes; the sixth is always 0.
inline Number<5> add3(const Number<4>& a, const Number<4>& b, const Number<4>& c) {
  const Number<5> ab = add(a, b);
  const Number<6> sum = add(ab, Number<5>{c[0], c[1], c[2], c[3], 0});
  return {sum[0], sum[1], sum[2], sum[3], sum[4]};
}

// 1 where a > b.
template <std::size_t Planes>
std::uint64_t greater(const Number<Planes>& a, const Number<Planes>& b) {
  std::uint64_t result = 0;
  for (std::size_t p = 0; p < Planes; ++p) {
    result = (a[p] & ~b[p]) | (~(a[p] ^ b[p]) & result);
  }
  return result;
}

}  // namespace binderjet::bits
