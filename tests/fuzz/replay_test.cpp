// SPDX-License-Identifier: MIT
#include "fuzz/readers.h"
#include "host/io/files.h"
#include "lab/temporary_folder.h"
#include "testing.h"
#include "topple/kernel_testing/random.h"

namespace topple::fuzz {
namespace {

namespace fs = std::filesystem;

// What fuzzing found to lead to different places in a reader, and what once broke it.
class Corpus : public ::testing::TestWithParam<Reader> {
  protected:
    Corpus() {
        const auto corpus = fs::path(TOPPLE_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
        for (const auto& entry : fs::directory_iterator(corpus))
            inputs_.push_back(test::bytes_of_file(entry.path()));
        std::ranges::sort(inputs_);
    }
    void expect_read_or_refused(const std::string& input) const {
        EXPECT_EQ(try_input(GetParam(), folder_.path(), input), "") << input;
    }
    // Whether the input tried last is read.
    bool is_read() const {
        try {
            GetParam().read(folder_.path() / GetParam().file);
            return true;
        } catch (const Error&) {
            return false;
        }
    }

    std::vector<std::string> inputs_;
    const scenes::TemporaryFolder folder_{"topple_replay"};
};

TEST_P(Corpus, is_read_or_refused) {
    ASSERT_FALSE(inputs_.empty());
    for (const std::string& input : inputs_) expect_read_or_refused(input);
}

// With up to four bits flipped, bytes set, removed, doubled or put in.
std::string changed(std::string bytes, test::Random& random) {
    static const char* const tokens[] = {"nan", "-1",   "1e999", "18446744073709551615", "\n", " ",
                                         "0",   "\xff", ","};
    for (auto edits = 1 + random.below(4); edits > 0 && !bytes.empty(); --edits) {
        const auto at = random.below(bytes.size());
        switch (random.below(5)) {
            case 0:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
                break;
            case 1:
                bytes[at] = static_cast<char>(random.below(256));
                break;
            case 2:
                bytes.erase(at, 1 + random.below(8));
                break;
            case 3:
                bytes.insert(at, bytes.substr(at, 1 + random.below(8)));
                break;
            default:
                bytes.insert(at, tokens[random.below(std::size(tokens))]);
        }
    }
    return bytes;
}

// Of what is read all that is cut off anywhere, and changes.
TEST_P(Corpus, is_read_or_refused_whatever_is_done_to_it) {
    constexpr std::size_t most_inputs = 12;
    std::size_t whole = 0;
    test::Random random(inputs_.size());
    for (const std::string& input : inputs_) {
        expect_read_or_refused(input);
        if (whole == most_inputs || !is_read()) continue;
        ++whole;
        for (std::size_t length = 0; length < input.size(); length += 1 + input.size() / 500)
            expect_read_or_refused(input.substr(0, length));
        for (int n = 0; n < 300; ++n) expect_read_or_refused(changed(input, random));
    }
    EXPECT_GT(whole, 0u);
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, ::testing::ValuesIn(readers()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace topple::fuzz
