// SPDX-License-Identifier: AGPL-3.0-or-later
// OpenIGTLink's own library as the other side of the codec, with its check values on, both ways.
#include <cstring>
#include <string>

#include <igtlImageMessage.h>
#include <igtlSensorMessage.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>
#include <igtlUnit.h>
#include <igtl_header.h>
#include <igtl_unit.h>

#include <gtest/gtest.h>

#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/message.h"
#include "artus/detail/exchange/igtl/stream_reader.h"

namespace {

namespace ours = artus::igtl;

/// The bytes as the library receives them: header, then body, checked.
template <class Theirs>
typename Theirs::Pointer receive(const std::string& bytes) {
  auto header = igtl::MessageHeader::New();
  header->InitPack();
  std::memcpy(header->GetPackPointer(), bytes.data(), ours::kHeaderSize);
  EXPECT_EQ(header->Unpack(), igtl::MessageHeader::UNPACK_HEADER);
  auto message = Theirs::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  EXPECT_EQ(static_cast<std::size_t>(message->GetPackBodySize()), bytes.size() - ours::kHeaderSize);
  std::memcpy(message->GetPackBodyPointer(), bytes.data() + ours::kHeaderSize,
              bytes.size() - ours::kHeaderSize);
  EXPECT_NE(message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY, 0) << "checksum";
  return message;
}

/// What the library sends, as ours reads it.
template <class Theirs>
ours::Message send(Theirs& message) {
  message->SetDeviceName("Tracker");
  message->Pack();
  const std::string bytes(static_cast<const char*>(message->GetPackPointer()),
                          static_cast<std::size_t>(message->GetPackSize()));
  ours::StreamReader reader([](std::string_view) { return std::size_t{1U << 20U}; });
  ours::Message got;
  int n = 0;
  const auto taken = reader.take(bytes, [&](const ours::Message& m) {
    got = m;
    ++n;
  });
  EXPECT_TRUE(taken) << taken.error().to_string();
  EXPECT_EQ(n, 1);
  EXPECT_EQ(got.device, "Tracker");
  return got;
}

std::string packed(const char* type, std::string content) {
  ours::Message message;
  message.type = type;
  message.device = "Image_Reference";
  message.time = ours::utc_time_now();
  message.content = std::move(content);
  return ours::pack(message);
}

ours::Matrix some_matrix() {
  ours::Matrix matrix;
  matrix << 0, -1, 0, 12.5, 1, 0, 0, -7.25, 0, 0, 1, 300;
  return matrix;
}

TEST(IgtlPeer, ReadsOurTransform) {
  const auto message =
      receive<igtl::TransformMessage>(packed("TRANSFORM", ours::pack_transform(some_matrix())));
  igtl::Matrix4x4 matrix;
  message->GetMatrix(matrix);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j)
      EXPECT_EQ(static_cast<double>(matrix[i][j]), some_matrix()(i, j)) << i << ' ' << j;
  EXPECT_STREQ(message->GetDeviceName(), "Image_Reference");
}

TEST(IgtlPeer, SendsATransformThatWeRead) {
  igtl::Matrix4x4 matrix;
  igtl::IdentityMatrix(matrix);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) matrix[i][j] = static_cast<float>(some_matrix()(i, j));
  auto message = igtl::TransformMessage::New();
  message->SetMatrix(matrix);
  const auto got = ours::parse_transform(send(message).content);
  ASSERT_TRUE(got);
  EXPECT_EQ(*got, some_matrix());
}

TEST(IgtlPeer, ReadsOurImage) {
  ours::Image image;
  image.width = 64;
  image.height = 48;
  image.image_to_reference << 0.1, 0, 0, 10, 0, 0, -0.1, 20, 0, 0.1, 0, 30;
  std::string grey(64 * 48, '\0');
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<char>(i);
  image.grey = grey;
  const auto message = receive<igtl::ImageMessage>(packed("IMAGE", ours::pack_image(image)));
  int size[3];
  message->GetDimensions(size);
  EXPECT_EQ(size[0], 64);
  EXPECT_EQ(size[1], 48);
  EXPECT_EQ(size[2], 1);
  float spacing[3];
  message->GetSpacing(spacing);
  EXPECT_NEAR(spacing[0], 0.1, 1e-6);
  EXPECT_EQ(message->GetScalarType(), igtl::ImageMessage::TYPE_UINT8);
  igtl::Matrix4x4 matrix;
  message->GetMatrix(matrix);
  EXPECT_NEAR(matrix[0][3], 10 + 0.1 * 31.5, 1e-5);  // the middle of the picture
  EXPECT_NEAR(matrix[2][3], 30 + 0.1 * 23.5, 1e-5);
  EXPECT_EQ(std::memcmp(message->GetScalarPointer(), grey.data(), grey.size()), 0);
}

TEST(IgtlPeer, SendsAnImageThatWeRead) {
  auto message = igtl::ImageMessage::New();
  message->SetDimensions(4, 3, 1);
  message->SetSpacing(0.5F, 0.5F, 0.5F);
  message->SetScalarType(igtl::ImageMessage::TYPE_UINT8);
  message->AllocateScalars();
  std::memcpy(message->GetScalarPointer(), "abcdefghijkl", 12);
  const ours::Message got = send(message);
  const auto image = ours::parse_image(got.content);
  ASSERT_TRUE(image) << image.error().to_string();
  EXPECT_EQ(image->grey, "abcdefghijkl");
  EXPECT_NEAR(image->image_to_reference(0, 0), 0.5, 1e-6);
}

TEST(IgtlPeer, ReadsOurTextsStatesAndForces) {
  EXPECT_STREQ(
      receive<igtl::StringMessage>(packed("STRING", ours::pack_string("2.5 N")))->GetString(),
      "2.5 N");
  const auto status = receive<igtl::StatusMessage>(
      packed("STATUS", ours::pack_status({ours::Status::kOk, 3, "None", "ready"})));
  EXPECT_EQ(status->GetCode(), igtl::StatusMessage::STATUS_OK);
  EXPECT_STREQ(status->GetStatusString(), "ready");
  const auto sensor = receive<igtl::SensorMessage>(
      packed("SENSOR", ours::pack_sensor({ours::kNewton, {0.25, -4}})));
  ASSERT_EQ(sensor->GetLength(), 2U);
  EXPECT_EQ(sensor->GetValue(1), -4);
  auto newton = igtl::Unit::New();
  newton->Append(igtl::Unit::SI_DERIVED_NEWTON, 1);
  EXPECT_EQ(newton->Pack(), ours::kNewton);
  auto metre = igtl::Unit::New();
  metre->Append(igtl::Unit::SI_BASE_METER, 1);
  EXPECT_EQ(metre->Pack(), ours::kMetre);
  auto pascal = igtl::Unit::New();
  pascal->Append(igtl::Unit::SI_DERIVED_PASCAL, 1);
  EXPECT_EQ(pascal->Pack(), ours::kPascal);
  auto volume = igtl::Unit::New();
  volume->Append(igtl::Unit::SI_BASE_METER, 3);
  EXPECT_EQ(volume->Pack(), ours::kCubicMetre);
  // The class's second Append writes over the first; its C code has room for all.
  igtl_unit_data flow{};
  flow.unit[0] = IGTL_UNIT_SI_BASE_METER;
  flow.exp[0] = 3;
  flow.unit[1] = IGTL_UNIT_SI_BASE_SECOND;
  flow.exp[1] = -1;
  EXPECT_EQ(igtl_unit_pack(&flow), ours::kCubicMetrePerSecond);
}

TEST(IgtlPeer, SendsTextsAndStatesThatWeRead) {
  auto text = igtl::StringMessage::New();
  text->SetString("hello");
  EXPECT_EQ(ours::parse_string(send(text).content).value_or(""), "hello");
  auto status = igtl::StatusMessage::New();
  status->SetCode(igtl::StatusMessage::STATUS_BUSY);
  status->SetSubCode(5);
  status->SetErrorName("Busy");
  status->SetStatusString("wait");
  const auto got = ours::parse_status(send(status).content);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->code, 6);
  EXPECT_EQ(got->error, "Busy");
  EXPECT_EQ(got->message, "wait");
}

}  // namespace
