// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/uff_file.h"

#include <vector>

#include <hdf5.h>

#include <gtest/gtest.h>

namespace artus {
namespace {

/// Two lines of three samples, which are three times as many of RF.
RfLines two_lines() {
  RfLines lines;
  lines.n_lines = 2;
  lines.n_samples = 3;
  lines.n_rf_samples = 9;
  for (int i = 0; i < 6; ++i) lines.iq.emplace_back(static_cast<float>(i), static_cast<float>(-i));
  lines.rf.assign(18, 0.5F);
  lines.time_gain.assign(3, 1.0F);
  lines.origins = {-1e-3, 0, 0, 1e-3, 0, 0};
  lines.directions = {0, 0, 1, 0, 0, 1};
  lines.sampling_frequency = 10e6;
  lines.rf_sampling_frequency = 30e6;
  lines.centre_frequency = 7e6;
  lines.sound_speed = 1540;
  return lines;
}

/// A file's image, opened again by HDF5 itself.
class Opened {
 public:
  explicit Opened(std::string bytes) : bytes_(std::move(bytes)) {
    access_ = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access_, 1U << 16U, false);
    H5Pset_file_image(access_, bytes_.data(), bytes_.size());
    file_ = H5Fopen("in memory", H5F_ACC_RDONLY, access_);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  Opened(Opened&&) = delete;
  Opened& operator=(Opened&&) = delete;
  ~Opened() {
    H5Fclose(file_);
    H5Pclose(access_);
  }
  [[nodiscard]] std::vector<double> values(const char* path) const {
    const hid_t data = H5Dopen2(file_, path, H5P_DEFAULT);
    const hid_t space = H5Dget_space(data);
    std::vector<double> out(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data());
    H5Sclose(space);
    H5Dclose(data);
    return out;
  }
  [[nodiscard]] std::string text(const char* object, const char* attribute) const {
    const hid_t read = H5Aopen_by_name(file_, object, attribute, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(read);
    std::string out(H5Tget_size(type), ' ');
    H5Aread(read, type, out.data());
    H5Tclose(type);
    H5Aclose(read);
    return out.c_str();
  }

 private:
  std::string bytes_;
  hid_t access_;
  hid_t file_;
};

TEST(UffFile, HoldsLinesScanAndFrequenciesUnderTheNamesOfTheToolbox) {
  const auto bytes = uff_bytes(two_lines());
  ASSERT_TRUE(bytes) << bytes.error().message;
  const Opened file(*bytes);
  EXPECT_EQ(file.text("/", "version"), "v1.2.0");
  EXPECT_EQ(file.text("/iq", "class"), "uff.beamformed_data");
  EXPECT_EQ(file.text("/iq/scan", "class"), "uff.linear_scan");
  EXPECT_EQ(file.values("/iq/data/real"), (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(file.values("/iq/data/imag"), (std::vector<double>{0, -1, -2, -3, -4, -5}));
  EXPECT_EQ(file.values("/rf/data"), std::vector<double>(18, 0.5));
  EXPECT_EQ(file.values("/iq/scan/x_axis"), (std::vector<double>{-1e-3, 1e-3}));
  EXPECT_DOUBLE_EQ(file.values("/iq/scan/z_axis")[1], 1540 / (2 * 10e6));
  EXPECT_DOUBLE_EQ(file.values("/rf/scan/z_axis")[3], 1540 / (2 * 10e6));
  EXPECT_EQ(file.values("/iq/modulation_frequency"), std::vector<double>{7e6});
  EXPECT_EQ(file.values("/rf/modulation_frequency"), std::vector<double>{0});
  EXPECT_EQ(file.values("/rf/sampling_frequency"), std::vector<double>{30e6});
  EXPECT_EQ(file.values("/iq/probe/geometry").size(), 14U);
}

TEST(UffFile, SaysThatThereIsNoChannelData) {
  const Opened file(uff_bytes(two_lines()).value());
  std::string info;
  for (const double letter : file.values("/iq/info")) info += static_cast<char>(letter);
  EXPECT_NE(info.find("there is no channel data"), std::string::npos);
}

TEST(UffFile, ACurvedFaceIsAFan) {
  RfLines curved = two_lines();
  curved.face_radius = 0.06;
  const Opened fan(uff_bytes(curved).value());
  EXPECT_EQ(fan.text("/iq/scan", "class"), "uff.sector_scan");
  EXPECT_EQ(fan.values("/iq/scan/depth_axis")[0], 0.06);  // from the fan's centre
  EXPECT_EQ(fan.values("/iq/scan/apex/distance"), std::vector<double>{0.06});
}

TEST(UffFile, ASteeredFaceIsPixels) {
  RfLines steered = two_lines();
  steered.steering = 0.1;
  steered.directions = {0.6, 0, 0.8, 0.6, 0, 0.8};
  const Opened pixels(uff_bytes(steered).value());
  EXPECT_EQ(pixels.text("/iq/scan", "class"), "uff.scan");
  const double step = 1540 / (2 * 10e6);
  EXPECT_DOUBLE_EQ(pixels.values("/iq/scan/x")[4], 1e-3 + 0.6 * step);
  EXPECT_DOUBLE_EQ(pixels.values("/iq/scan/z")[5], 0.8 * 2 * step);
}

TEST(UffFile, TheSameLinesHaveTheSameBytes) {
  EXPECT_EQ(uff_bytes(two_lines()).value(), uff_bytes(two_lines()).value());
}

}  // namespace
}  // namespace artus
