// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/image_codec.h"

#include <bit>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <jpeglib.h>
#include <png.h>
#include <zlib.h>

namespace gpo {
namespace {

// The libraries report errors by longjmp, because exceptions must not pass through C. A jump skips
// destructors: objects that have one are outside of the steps that call the libraries.

/// Runs a step that calls a library. Returns false if it jumps to `place`.
template <class Step>
bool succeeds(std::jmp_buf& place, const Step& step) {
  // NOLINTNEXTLINE(cert-err52-cpp): the libraries offer no other way
  if (setjmp(place) != 0) return false;
  step();
  return true;
}

[[noreturn]] void fail_png(png_structp png, png_const_charp /*message*/) { png_longjmp(png, 1); }
void ignore_png_warning(png_structp /*png*/, png_const_charp /*message*/) {}

template <class Step>
bool succeeds(png_structp png, const Step& step) {
  return succeeds(png_jmpbuf(png), step);
}

struct JpegErrors : jpeg_error_mgr {
  std::jmp_buf place;
};

[[noreturn]] void fail_jpeg(j_common_ptr jpeg) {
  std::longjmp(static_cast<JpegErrors*>(jpeg->err)->place, 1);
}
void ignore_jpeg_message(j_common_ptr /*jpeg*/) {}

jpeg_error_mgr* quiet_errors(JpegErrors& errors) {
  jpeg_std_error(&errors);
  errors.error_exit = fail_jpeg;
  errors.output_message = ignore_jpeg_message;
  return &errors;
}

struct PngReader {
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail_png, ignore_png_warning);
  png_infop info = png_create_info_struct(png);
  PngReader() {
    if (info == nullptr) throw std::bad_alloc();
  }
  PngReader(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct PngWriter {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail_png, ignore_png_warning);
  png_infop info = png_create_info_struct(png);
  PngWriter() {
    if (info == nullptr) throw std::bad_alloc();
  }
  PngWriter(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

struct JpegReader {
  JpegErrors errors{};
  jpeg_decompress_struct jpeg{};
  JpegReader() {
    jpeg.err = quiet_errors(errors);
    if (!succeeds(errors.place, [this] { jpeg_create_decompress(&jpeg); })) throw std::bad_alloc();
  }
  JpegReader(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
};

struct JpegWriter {
  JpegErrors errors{};
  jpeg_compress_struct jpeg{};
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  JpegWriter() {
    jpeg.err = quiet_errors(errors);
    if (!succeeds(errors.place, [this] {
          jpeg_create_compress(&jpeg);
          jpeg_mem_dest(&jpeg, &bytes, &count);
        }))
      throw std::bad_alloc();
  }
  JpegWriter(const JpegWriter&) = delete;
  ~JpegWriter() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }
};

std::vector<png_bytep> rows_of(const cv::Mat& image) {
  std::vector<png_bytep> rows;
  for (int row = 0; row < image.rows; ++row) rows.push_back(image.data + row * image.step);
  return rows;
}

/// Makes libpng return blue, green, red without alpha, and 16-bit numbers in memory order.
void convert_to_bgr(png_structp png, int color, int bits) {
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_strip_alpha(png);
  if (color == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if ((color & PNG_COLOR_MASK_COLOR) != 0) {
    png_set_bgr(png);
  } else {
    if (bits < 8) png_set_expand_gray_1_2_4_to_8(png);
    png_set_gray_to_rgb(png);
  }
  png_set_interlace_handling(png);
}

void read_png_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto& left = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (left.size() < count) png_error(png, "truncated");
  std::memcpy(to, left.data(), count);
  left.remove_prefix(count);
}

/// Reads the header and sets up the conversion. Returns the bits of a channel.
int begin_png(const PngReader& reader, std::string_view& bytes) {
  png_set_read_fn(reader.png, &bytes, read_png_bytes);
  png_read_info(reader.png, reader.info);
  const int bits = png_get_bit_depth(reader.png, reader.info);
  convert_to_bgr(reader.png, png_get_color_type(reader.png, reader.info), bits);
  png_read_update_info(reader.png, reader.info);
  return bits;
}

/// Bytes that a PNG is written to.
struct PngBytes {
  std::string text;
  bool full = false;  ///< there is no memory for more
};

void append_png_bytes(png_structp png, png_bytep from, std::size_t count) {
  auto& bytes = *static_cast<PngBytes*>(png_get_io_ptr(png));
  try {
    bytes.text.append(reinterpret_cast<char*>(from), count);
  } catch (const std::exception&) {
    bytes.full = true;
  }
  if (bytes.full) png_error(png, "no memory");
}

void write_png(const PngWriter& writer, const cv::Mat& image, png_bytepp rows) {
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(writer.png, Z_BEST_SPEED);
  png_set_compression_strategy(writer.png, Z_RLE);
  constexpr int kColors[] = {0, PNG_COLOR_TYPE_GRAY, 0, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
  png_set_IHDR(writer.png,
               writer.info,
               static_cast<png_uint_32>(image.cols),
               static_cast<png_uint_32>(image.rows),
               image.depth() == CV_8U ? 8 : 16,
               kColors[image.channels()],
               PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  png_set_bgr(writer.png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(writer.png);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, writer.info);
}

void write_jpeg(jpeg_compress_struct& jpeg, const cv::Mat& image, int quality, png_bytepp rows) {
  jpeg.image_width = static_cast<JDIMENSION>(image.cols);
  jpeg.image_height = static_cast<JDIMENSION>(image.rows);
  jpeg.input_components = image.channels();
  jpeg.in_color_space = image.channels() == 1 ? JCS_GRAYSCALE : JCS_EXT_BGR;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg.optimize_coding = TRUE;
  jpeg_start_compress(&jpeg, TRUE);
  jpeg_write_scanlines(&jpeg, rows, jpeg.image_height);
  jpeg_finish_compress(&jpeg);
}

[[noreturn]] void refuse_to_encode(const cv::Mat& image, const char* format) {
  throw std::runtime_error(
      fmt::format("cannot encode an image of {}x{} as {}", image.cols, image.rows, format));
}

}  // namespace

cv::Mat decode_png(std::string_view bytes) {
  const PngReader reader;
  int bits = 0;
  if (!succeeds(reader.png, [&] { bits = begin_png(reader, bytes); })) return {};
  cv::Mat image(static_cast<int>(png_get_image_height(reader.png, reader.info)),
                static_cast<int>(png_get_image_width(reader.png, reader.info)),
                bits == 16 ? CV_16UC3 : CV_8UC3);
  if (png_get_rowbytes(reader.png, reader.info) > image.step) return {};
  std::vector<png_bytep> rows = rows_of(image);
  const bool whole = succeeds(reader.png, [&] {
    png_read_image(reader.png, rows.data());
    png_read_end(reader.png, reader.info);
  });
  return whole ? image : cv::Mat();
}

cv::Mat decode_jpeg(std::string_view bytes) {
  JpegReader reader;
  jpeg_decompress_struct& jpeg = reader.jpeg;
  const bool begun = succeeds(reader.errors.place, [&] {
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    if (jpeg.num_components == 4) return;
    jpeg.out_color_space = JCS_EXT_BGR;
    jpeg_start_decompress(&jpeg);
  });
  if (!begun || jpeg.num_components == 4) return {};
  cv::Mat image(static_cast<int>(jpeg.output_height), static_cast<int>(jpeg.output_width), CV_8UC3);
  std::vector<png_bytep> rows = rows_of(image);
  const bool whole = succeeds(reader.errors.place, [&] {
    while (jpeg.output_scanline < jpeg.output_height)
      jpeg_read_scanlines(
          &jpeg, &rows[jpeg.output_scanline], jpeg.output_height - jpeg.output_scanline);
    jpeg_finish_decompress(&jpeg);
  });
  return whole && jpeg.err->num_warnings == 0 ? image : cv::Mat();
}

std::string encode_png(const cv::Mat& image) {
  const PngWriter writer;
  PngBytes bytes;
  png_set_write_fn(writer.png, &bytes, append_png_bytes, nullptr);
  std::vector<png_bytep> rows = rows_of(image);
  const bool written = succeeds(writer.png, [&] { write_png(writer, image, rows.data()); });
  if (bytes.full) throw std::bad_alloc();
  if (!written) refuse_to_encode(image, "PNG");
  return std::move(bytes.text);
}

std::string encode_jpeg(const cv::Mat& image, int quality) {
  JpegWriter writer;
  std::vector<png_bytep> rows = rows_of(image);
  if (!succeeds(writer.errors.place, [&] { write_jpeg(writer.jpeg, image, quality, rows.data()); }))
    refuse_to_encode(image, "JPEG");
  return {reinterpret_cast<const char*>(writer.bytes), writer.count};
}

}  // namespace gpo
