// SPDX-License-Identifier: GPL-3.0-or-later
// The job container keeps what it is given, and says so when it cannot.
#include "transport/job/job_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/transport/sample_job.h"
#include "transport/base/bytes.h"

namespace binderjet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(JobFile, GivesBackWhatWasWritten) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 40);
  const auto reader = JobReader::open(folder / "a.bjob");
  ASSERT_TRUE(reader) << reader.error().what;
  EXPECT_TRUE(reader->whole());
  EXPECT_EQ(reader->damage(), "");
  EXPECT_EQ(reader->header(), kSampleHeader);
  ASSERT_EQ(reader->layers(RecordKind::kMask).size(), 40U);
  for (const RecordKind kind : {RecordKind::kMask, RecordKind::kColor}) {
    for (int layer = 0; layer < 40; ++layer) {
      const auto payload = reader->read(kind, layer);
      ASSERT_TRUE(payload) << payload.error().what;
      EXPECT_EQ(*payload, sample_payload(kind, layer));
      EXPECT_EQ(*reader->read_record(kind, layer), encode_record(kind, layer, *payload));
    }
  }
  EXPECT_TRUE(verify_job(folder / "a.bjob"));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a.bjob"));
}

// The bytes are a promise to other programs: they stand in job_format.h.
TEST(JobFile, HasTheBytesItsDescriptionSays) {
  const TempFolder folder;
  auto writer = JobWriter::create(folder / "a.bjob", "{}");
  ASSERT_TRUE(writer->append(encode_record(RecordKind::kColor, 7, {})));
  ASSERT_TRUE(writer->finish());
  const std::string text = file_text(folder / "a.bjob");
  const std::span<const std::byte> bytes = as_bytes(text);
  EXPECT_EQ(text.substr(0, 8), "BJOB\r\n\x1a\n");
  EXPECT_EQ(get_le<std::uint32_t>(bytes, 8), 1U);
  EXPECT_EQ(get_le<std::uint64_t>(bytes, 16), 2U);
  EXPECT_EQ(text.substr(32, 2), "{}");
  EXPECT_EQ(text.substr(34, 4), "BJLR");
  EXPECT_EQ(get_le<std::uint32_t>(bytes, 34 + 4), 2U);
  EXPECT_EQ(get_le<std::uint32_t>(bytes, 34 + 8), 7U);
  EXPECT_EQ(get_le<std::uint32_t>(bytes, 34 + 12), 0U);
  const auto frame_bytes = get_le<std::uint32_t>(bytes, 34 + 16);
  EXPECT_EQ(get_le<std::uint32_t>(bytes, 74), 0xFD2FB528U) << "a zstd frame";
  EXPECT_EQ(get_le<std::uint8_t>(bytes, 78) & 0x04, 0x04) << "with zstd's checksum";
  const std::size_t index = 74 + frame_bytes;
  EXPECT_EQ(text.substr(index, 4), "BJIX");
  EXPECT_EQ(get_le<std::uint64_t>(bytes, index + 16), 34U);
  EXPECT_EQ(text.substr(index + 40, 4), "BJEN");
  EXPECT_EQ(get_le<std::uint64_t>(bytes, index + 48), index);
  EXPECT_EQ(text.size(), index + 80);
}

TEST(JobFile, HasTheSameBytesEveryTime) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 40);
  write_sample_job(folder / "b.bjob", 0, 40);
  EXPECT_EQ(file_text(folder / "a.bjob"), file_text(folder / "b.bjob"));
}

TEST(JobFile, KeepsAJobWithoutLayersAndAnEmptyPayload) {
  const TempFolder folder;
  write_sample_job(folder / "none.bjob", 0, 0, "");
  const auto none = JobReader::open(folder / "none.bjob");
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->whole());
  EXPECT_THAT(none->layers(RecordKind::kMask), IsEmpty());
  auto writer = JobWriter::create(folder / "empty.bjob", "{}");
  ASSERT_TRUE(writer->append(encode_record(RecordKind::kMask, 0, {})));
  ASSERT_TRUE(writer->finish());
  EXPECT_THAT(*JobReader::open(folder / "empty.bjob")->read(RecordKind::kMask, 0), IsEmpty());
  EXPECT_TRUE(verify_job(folder / "empty.bjob"));
}

TEST(JobFile, IsReadByManyThreadsAtOnce) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 40);
  const auto reader = JobReader::open(folder / "a.bjob");
  std::vector<int> right(4);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < right.size(); ++t) {
    threads.emplace_back([&reader, &right, t] {
      for (int layer = 0; layer < 40; ++layer) {
        const auto payload = reader->read(RecordKind::kMask, layer);
        right[t] += payload && *payload == sample_payload(RecordKind::kMask, layer) ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(right, testing::Each(40));
}

TEST(JobFile, HasNoNameBeforeItIsWhole) {
  const TempFolder folder;
  {
    auto writer = JobWriter::create(folder / "a.bjob", kSampleHeader);
    ASSERT_TRUE(writer->append(sample_records(0)));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.bjob"));
  }
  EXPECT_THAT(names_in(folder.path()), IsEmpty()) << "an unfinished job goes away";
}

TEST(JobFile, ReplacesAJobOnlyByAWholeOne) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 3);
  const std::string before = file_text(folder / "a.bjob");
  { ASSERT_TRUE(JobWriter::create(folder / "a.bjob", "other")->append(sample_records(0))); }
  EXPECT_EQ(file_text(folder / "a.bjob"), before);
}

TEST(JobFile, NeverReplacesADevice) {
  const auto writer = JobWriter::create("/dev/null", "{}");
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().kind, FailureKind::kDevice);
}

TEST(JobFile, RefusesRecordsOutOfOrderOrDamaged) {
  const TempFolder folder;
  auto writer = JobWriter::create(folder / "a.bjob", "{}");
  ASSERT_TRUE(writer->append(sample_records(5)));
  EXPECT_FALSE(writer->append(sample_records(5)));
  EXPECT_FALSE(writer->append(sample_records(4)));
  auto records = sample_records(6);
  records.back() ^= std::byte{1};
  EXPECT_FALSE(writer->append(records));
  EXPECT_FALSE(writer->append(std::span(records).first(50)));
  ASSERT_TRUE(writer->append(sample_records(6))) << "a refused record leaves no trace";
  ASSERT_TRUE(writer->finish());
  EXPECT_TRUE(verify_job(folder / "a.bjob"));
  EXPECT_THAT(JobReader::open(folder / "a.bjob")->layers(RecordKind::kMask), ElementsAre(5, 6));
}

TEST(JobFile, SaysThatAFileIsNotAJob) {
  const TempFolder folder;
  write_text(folder / "a.stl", std::string(200, 'x'));
  EXPECT_THAT(JobReader::open(folder / "a.stl").error().what, HasSubstr("not a job"));
  EXPECT_EQ(JobReader::open(folder / "none").error().kind, FailureKind::kBadInput);
  EXPECT_EQ(JobReader::open(folder.path()).error().kind, FailureKind::kBadInput);
}

// Offsets of the layers' ends, so that a cut says exactly how many layers are whole.
TEST(CutJob, IsReadUpToItsLastWholeLayerAndSaysSo) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 40);
  const std::string whole = file_text(folder / "a.bjob");
  const auto reader = JobReader::open(folder / "a.bjob");
  const std::uint64_t first = reader->entries().front().offset;
  auto random = seeded_random();
  for (int i = 0; i < 200; ++i) {
    const std::size_t length = random_below(random, whole.size());
    write_text(folder / "cut.bjob", whole.substr(0, length));
    const auto cut = JobReader::open(folder / "cut.bjob");
    if (length < first) {
      ASSERT_FALSE(cut);
      EXPECT_THAT(cut.error().what, HasSubstr("cut in its header"));
      continue;
    }
    int layers = 0;
    for (const auto& entry : reader->entries()) {
      layers += entry.kind == RecordKind::kColor && entry.end() <= length ? 1 : 0;
    }
    // Cut behind the first mask and before the next record says its kind: nobody can know that
    // color was to follow.
    const std::uint64_t mask_end = reader->entries()[0].end();
    const bool lone_mask =
        layers == 0 && length >= mask_end && length < mask_end + job_format::kRecordHeadBytes;
    ASSERT_TRUE(cut) << cut.error().what;
    EXPECT_FALSE(cut->whole());
    EXPECT_FALSE(verify_job(folder / "cut.bjob"));
    const auto read = cut->layers(RecordKind::kMask);
    ASSERT_EQ(static_cast<int>(read.size()), layers + (lone_mask ? 1 : 0)) << "cut at " << length;
    if (lone_mask) continue;
    ASSERT_EQ(static_cast<int>(cut->layers(RecordKind::kColor).size()), layers);
    for (const int layer : read) {
      ASSERT_EQ(*cut->read(RecordKind::kMask, layer), sample_payload(RecordKind::kMask, layer));
      ASSERT_EQ(*cut->read(RecordKind::kColor, layer), sample_payload(RecordKind::kColor, layer));
    }
    if (layers == 0) {
      EXPECT_THAT(cut->damage(), HasSubstr("cut before its first whole layer"));
    } else if (layers < 40) {
      const std::string word = "cut after layer " + std::to_string(layers - 1) + "; layers " +
                               std::to_string(layers) + " on are missing";
      EXPECT_THAT(cut->damage(), HasSubstr(word));
      EXPECT_THAT(cut->read(RecordKind::kMask, layers).error().what, HasSubstr("missing"));
    }
  }
}

TEST(CutJob, HasNoLayerWhoseColorIsMissing) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 3);
  const auto reader = JobReader::open(folder / "a.bjob");
  const std::uint64_t mask_of_2_ends = reader->entries()[4].end();
  for (const std::uint64_t more : {0, 20, 50}) {
    std::filesystem::copy_file(folder / "a.bjob", folder / "cut.bjob",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder / "cut.bjob", mask_of_2_ends + more);
    const auto cut = JobReader::open(folder / "cut.bjob");
    EXPECT_THAT(cut->layers(RecordKind::kMask), ElementsAre(0, 1));
    EXPECT_THAT(cut->damage(), HasSubstr("layers 2 on are missing"));
  }
}

// Reads all there is; false if anything says that it is damaged. A wrong payload ends the test.
bool reads_without_a_word(const std::string& path) {
  const auto reader = JobReader::open(path);
  if (!reader || !reader->whole()) return false;
  bool right = reader->header() == kSampleHeader && reader->entries().size() == 80;
  for (const RecordKind kind : {RecordKind::kMask, RecordKind::kColor}) {
    for (int layer = 0; layer < 40; ++layer) {
      const auto payload = reader->read(kind, layer);
      if (payload) {
        EXPECT_EQ(*payload, sample_payload(kind, layer)) << "a wrong payload, and no word";
      }
      right = right && payload;
    }
  }
  return right;
}

TEST(FlippedBit, IsFoundWhereverItIs) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 40);
  const std::string whole = file_text(folder / "a.bjob");
  ASSERT_TRUE(reads_without_a_word(folder / "a.bjob"));
  auto random = seeded_random();
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string flipped = whole;
    const std::size_t at = random_below(random, whole.size());
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << random_below(random, 8)));
    write_text(folder / "flipped.bjob", flipped);
    const auto verdict = verify_job(folder / "flipped.bjob");
    EXPECT_FALSE(verdict) << "byte " << at;
    EXPECT_FALSE(reads_without_a_word(folder / "flipped.bjob")) << "byte " << at;
    found += verdict ? 0 : 1;
  }
  EXPECT_EQ(found, 2000);
}

// Random places hardly ever hit the few bytes beside the frames, so these are tried one and all.
TEST(FlippedBit, IsFoundInEveryBitOfASmallJob) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 1, "{}", false);
  const std::string whole = file_text(folder / "a.bjob");
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    write_text(folder / "flipped.bjob", flipped);
    ASSERT_FALSE(verify_job(folder / "flipped.bjob")) << "bit " << bit;
  }
}

TEST(FlippedBit, SpoilsOneLayerAndNamesIt) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 40);
  std::string text = file_text(folder / "a.bjob");
  const auto entry = JobReader::open(folder / "a.bjob")->entries()[2 * 17];
  text[entry.offset + 60] = static_cast<char>(text[entry.offset + 60] ^ 1);
  write_text(folder / "a.bjob", text);
  const auto reader = JobReader::open(folder / "a.bjob");
  EXPECT_THAT(reader->read(RecordKind::kMask, 17).error().what, HasSubstr("layer 17 is damaged"));
  EXPECT_TRUE(reader->read(RecordKind::kMask, 18));
}

TEST(JobFile, NoticesBytesBehindItsEnd) {
  const TempFolder folder;
  write_sample_job(folder / "a.bjob", 0, 3);
  write_text(folder / "b.bjob", file_text(folder / "a.bjob") + "x");
  EXPECT_FALSE(verify_job(folder / "b.bjob"));
}

// Right checksums around a wrong length: what a flipped bit cannot do, and somebody can.
TEST(JobFile, TrustsNoLength) {
  const TempFolder folder;
  std::vector<std::byte> record =
      encode_record(RecordKind::kMask, 0, sample_payload(RecordKind::kMask, 0));
  auto head = *job_format::decode_record_head(record);
  head.payload_bytes = 1U << 30;
  const auto lie = job_format::encode_record_head(head);
  std::copy(lie.begin(), lie.end(), record.begin());
  auto writer = JobWriter::create(folder / "a.bjob", "{}");
  ASSERT_TRUE(writer->append(record));
  ASSERT_TRUE(writer->finish());
  const auto payload = JobReader::open(folder / "a.bjob")->read(RecordKind::kMask, 0);
  ASSERT_FALSE(payload);
  EXPECT_THAT(payload.error().what, HasSubstr("layer 0 has a wrong length"));
}

}  // namespace
}  // namespace binderjet
