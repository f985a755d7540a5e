// SPDX-License-Identifier: MIT
#include <csetjmp>
#include <cstddef>
#include <cstdio>
// These need what comes before.
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "io/text.h"
#include "points/formats/colour_image.h"

// libjpeg reports errors as libpng does: see png_reader.h.
namespace topple::io {
namespace {

struct Jump {
    jpeg_error_mgr manager;
    std::jmp_buf back;
    bool cut_short;
    char message[JMSG_LENGTH_MAX];
};

void on_error(j_common_ptr jpeg) {
    auto* jump = reinterpret_cast<Jump*>(jpeg->err);
    jump->manager.format_message(jpeg, jump->message);
    std::longjmp(jump->back, 1);
}

// The library goes on with grey where data is missing or makes no sense; we don't.
void on_message(j_common_ptr jpeg, int level) {
    const int code = jpeg->err->msg_code;
    if (level >= 0) return;
    auto* jump = reinterpret_cast<Jump*>(jpeg->err);
    jump->cut_short = code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER;
    if (jump->cut_short || code == JWRN_HUFF_BAD_CODE || code == JWRN_BOGUS_PROGRESSION)
        on_error(jpeg);
}

// The decompressor, destroyed when it goes.
struct JpegReader {
    jpeg_decompress_struct jpeg{};
    Jump jump{};
    JpegReader() {
        jpeg.err = jpeg_std_error(&jump.manager);
        jump.manager.error_exit = on_error;
        jump.manager.emit_message = on_message;
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
};

bool read_header(JpegReader* reader, const unsigned char* bytes, unsigned long size) {
    if (setjmp(reader->jump.back)) return false;
    jpeg_create_decompress(&reader->jpeg);
    jpeg_mem_src(&reader->jpeg, bytes, size);
    jpeg_read_header(&reader->jpeg, TRUE);
    return true;
}

bool read_rows(JpegReader* reader, unsigned char* to, std::size_t row_bytes) {
    if (setjmp(reader->jump.back)) return false;
    reader->jpeg.out_color_space = JCS_RGB;
    // The same bits whatever the machine's vector instructions are.
    reader->jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_decompress(&reader->jpeg);
    while (reader->jpeg.output_scanline < reader->jpeg.output_height) {
        JSAMPROW row = to + reader->jpeg.output_scanline * row_bytes;
        jpeg_read_scanlines(&reader->jpeg, &row, 1);
    }
    jpeg_finish_decompress(&reader->jpeg);
    return true;
}

}  // namespace

ColourImage decode_colour_jpeg(const std::filesystem::path& file, std::string_view bytes,
                               const SizeCheck& check) {
    JpegReader reader;
    const auto refuse = [&] {
        const std::string why = printable(reader.jump.message, sizeof(reader.jump.message));
        fail(file,
             (reader.jump.cut_short ? "is cut short, or a damaged JPEG (" : "is a damaged JPEG (") +
                 why + ")");
    };
    if (!read_header(&reader, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()))
        refuse();
    check(reader.jpeg.image_width, reader.jpeg.image_height);
    const auto space = reader.jpeg.jpeg_color_space;
    if (space == JCS_CMYK || space == JCS_YCCK)
        fail(file, "is a JPEG for print (CMYK); save it as RGB");
    ColourImage image{reader.jpeg.image_width, reader.jpeg.image_height, {}};
    const std::size_t row_bytes = std::size_t{3} * image.width;
    image.rgb.resize(row_bytes * image.height);
    if (!read_rows(&reader, image.rgb.data(), row_bytes)) refuse();
    return image;
}

}  // namespace topple::io
