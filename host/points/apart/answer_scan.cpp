// SPDX-License-Identifier: MIT
#include "points/apart/answer_scan.h"

#include <charconv>
#include <new>

#include "io/text.h"
#include "points/apart/scan_message.h"

namespace topple::reader {

std::string unit_text(double unit_m) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), unit_m, std::chars_format::hex);
    return {text, end.ptr};
}

void answer_scan(const std::string& unit, const std::filesystem::path& file,
                 const std::function<ScannedMap(const std::filesystem::path&, double)>& read) {
    double unit_m = 0;
    std::from_chars(unit.data(), unit.data() + unit.size(), unit_m, std::chars_format::hex);
    const auto refuse = [&](const std::string& why) {
        write_error({ErrorKind::input, io::path_text(file) + ": " + why});
    };
    try {
        write_scan(read(file, unit_m));
    } catch (const Error& error) {
        write_error(error);
    } catch (const std::bad_alloc&) {
        refuse(
            "takes more memory to read than a file of its size may; it is damaged, or, if you "
            "trust it, say ParseOptions::isolate = false");
    } catch (const std::exception& error) {
        refuse("can't be read: " + io::printable(error.what(), 200));
    }
}

}  // namespace topple::reader
