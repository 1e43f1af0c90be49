// SPDX-License-Identifier: GPL-3.0-or-later
// What libFuzzer and the replay of its corpus run: each decoder that sees bytes from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace binderjet {

inline void require(bool right) {
  if (!right) std::abort();
}

// Each aborts if a decoder breaks its word.
void fuzz_frames(const std::uint8_t* data, std::size_t size);
void fuzz_messages(const std::uint8_t* data, std::size_t size);
void fuzz_usb_texts(const std::uint8_t* data, std::size_t size);
void fuzz_records(const std::uint8_t* data, std::size_t size);
// The printer's side: any bytes down its pipe.
void fuzz_printer(const std::uint8_t* data, std::size_t size);

// Each aborts if a reader throws what is no Error, or returns what is not sound
// (input_targets.cpp).
void fuzz_stl(const std::uint8_t* data, std::size_t size);
void fuzz_ply(const std::uint8_t* data, std::size_t size);
void fuzz_obj(const std::uint8_t* data, std::size_t size);  // and its materials
void fuzz_off(const std::uint8_t* data, std::size_t size);
void fuzz_wrl(const std::uint8_t* data, std::size_t size);
void fuzz_3mf(const std::uint8_t* data, std::size_t size);
void fuzz_gltf(const std::uint8_t* data, std::size_t size);
void fuzz_profile(const std::uint8_t* data, std::size_t size);
void fuzz_job(const std::uint8_t* data, std::size_t size);  // its header, and the file
void fuzz_stack(const std::uint8_t* data, std::size_t size);
void fuzz_gauges(const std::uint8_t* data, std::size_t size);

}  // namespace binderjet
