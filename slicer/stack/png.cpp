// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/stack/png.h"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "slicer/layers/run_layer.h"

namespace binderjet {
namespace {

using Bytes = std::vector<std::byte>;

void put_u32(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::byte>(value >> shift));
}

// A chunk is its length, its type, its data and the CRC of the last two.
void put_chunk(Bytes& out, const char* type, std::span<const std::byte> data) {
  put_u32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(type[i]));
  out.insert(out.end(), data.begin(), data.end());
  put_u32(out, crc32_gzip_refl(0, reinterpret_cast<const unsigned char*>(out.data() + begin),
                               out.size() - begin));
}

// A filter byte stands before each row. Up subtracts the row above, so equal rows become zeros.
Bytes filter_up(std::span<const std::byte> bits, std::size_t stride, int height) {
  constexpr std::byte kUp{2};
  Bytes rows((stride + 1) * static_cast<std::size_t>(height));
  const std::byte* above = nullptr;
  std::byte* out = rows.data();
  for (int y = 0; y < height; ++y) {
    const std::byte* row = bits.data() + stride * static_cast<std::size_t>(y);
    *out++ = kUp;
    if (above == nullptr) {
      std::memcpy(out, row, stride);
    } else {
      for (std::size_t i = 0; i < stride; ++i) {
        out[i] = static_cast<std::byte>(std::to_integer<unsigned>(row[i]) -
                                        std::to_integer<unsigned>(above[i]));
      }
    }
    out += stride;
    above = row;
  }
  return rows;
}

Bytes zlib_deflate(Bytes& raw) {
  auto* in = reinterpret_cast<std::uint8_t*>(raw.data());
  const std::size_t size = raw.size();
  isal_huff_histogram counts{};
  isal_update_histogram(in, static_cast<int>(size), &counts);
  isal_hufftables codes;
  if (isal_create_hufftables(&codes, &counts) != 0) throw std::logic_error("no Huffman codes");
  isal_zstream stream{};  // what a job before left in it would change the bytes
  isal_deflate_stateless_init(&stream);
  Bytes out(size + size / 8 + 1024);
  // Level 1 puts its stream's address into its hash table: one mask in a thousand got other bytes.
  // Level 0 with codes of the data's own is 7 % larger and takes twice the time, 0.3 ms.
  stream.level = 0;
  stream.hufftables = &codes;
  stream.gzip_flag = IGZIP_ZLIB;
  stream.end_of_stream = 1;
  stream.next_in = in;
  stream.avail_in = static_cast<std::uint32_t>(size);
  stream.next_out = reinterpret_cast<std::uint8_t*>(out.data());
  stream.avail_out = static_cast<std::uint32_t>(out.size());
  if (isal_deflate_stateless(&stream) != COMP_OK) throw std::logic_error("deflate found no room");
  out.resize(stream.total_out);
  return out;
}

enum class Samples { kOneBitGray, kRgb };

Bytes encode(std::span<const std::byte> pixels, std::size_t stride, int width, int height,
             Samples samples, std::array<double, 2> pitch_mm) {
  assert(pixels.size() == stride * static_cast<std::size_t>(height));
  Bytes png;
  for (const unsigned c : {0x89U, 0x50U, 0x4eU, 0x47U, 0x0dU, 0x0aU, 0x1aU, 0x0aU}) {  // .PNG....
    png.push_back(static_cast<std::byte>(c));
  }
  Bytes header;
  put_u32(header, static_cast<std::uint32_t>(width));
  put_u32(header, static_cast<std::uint32_t>(height));
  const bool rgb = samples == Samples::kRgb;
  for (const int c : {rgb ? 8 : 1 /* bit depth */, rgb ? 2 : 0 /* kind of color */, 0, 0, 0}) {
    header.push_back(static_cast<std::byte>(c));
  }
  put_chunk(png, "IHDR", header);

  Bytes resolution;
  for (const double pitch : pitch_mm) {
    put_u32(resolution, static_cast<std::uint32_t>(std::lround(1000 / pitch)));
  }
  resolution.push_back(std::byte{1});  // pixels per meter
  put_chunk(png, "pHYs", resolution);

  Bytes rows = filter_up(pixels, stride, height);
  put_chunk(png, "IDAT", zlib_deflate(rows));
  put_chunk(png, "IEND", {});
  return png;
}

}  // namespace

std::vector<std::byte> encode_png_mask(std::span<const std::byte> bits, int width, int height,
                                       std::array<double, 2> pitch_mm) {
  return encode(bits, packed_row_bytes(width), width, height, Samples::kOneBitGray, pitch_mm);
}

std::vector<std::byte> encode_png_rgb(std::span<const std::byte> rgb, int width, int height,
                                      std::array<double, 2> pitch_mm) {
  return encode(rgb, 3 * static_cast<std::size_t>(width), width, height, Samples::kRgb, pitch_mm);
}

}  // namespace binderjet
