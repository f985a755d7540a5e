// SPDX-License-Identifier: MIT
#include "fuzz/readers.h"
#include "host/io/files.h"
#include "lab/temporary_folder.h"

namespace topple::fuzz {
namespace {

namespace fs = std::filesystem;

// What fuzzing found to lead to different places in a reader, and what once broke it.
class Corpus : public ::testing::TestWithParam<Reader> {};

TEST_P(Corpus, is_read_or_refused) {
    const Reader& reader = GetParam();
    const fs::path corpus = fs::path(TOPPLE_SOURCE_DIR) / "tests/fuzz/corpus" / reader.name;
    std::vector<fs::path> inputs;
    for (const auto& entry : fs::directory_iterator(corpus)) inputs.push_back(entry.path());
    std::sort(inputs.begin(), inputs.end());
    ASSERT_FALSE(inputs.empty());
    const scenes::TemporaryFolder folder("topple_replay");
    for (const fs::path& input : inputs) {
        EXPECT_EQ(try_input(reader, folder.path(), test::bytes_of_file(input)), "") << input;
    }
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, ::testing::ValuesIn(readers()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace topple::fuzz
