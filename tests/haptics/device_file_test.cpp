// SPDX-License-Identifier: AGPL-3.0-or-later
#include <fstream>

#include <gtest/gtest.h>

#include "artus/haptics/device.h"

namespace artus {
namespace {

constexpr const char* kLab = R"(format = 1
name = "lab arm"
[needle]
force_n = 6
torque_nm = 0.2
workspace_mm = [200, 160, 100]
centre_mm = [10, 0, -20]
[probe]
force_n = 15
torque_nm = 0.5
)";

TEST(DeviceFile, HasLimitsOfBothHandsAndWhereTheDeviceStands) {
  const auto device = parse_device_file(kLab, "lab.toml");
  ASSERT_TRUE(device) << device.error().to_string();
  EXPECT_EQ(device->name, "lab arm");
  EXPECT_EQ(device->force, 6);
  EXPECT_EQ(device->torque, 0.2);
  EXPECT_EQ(device->probe_force, 15);
  EXPECT_EQ(device->probe_torque, 0.5);
  EXPECT_TRUE(device->needle_half.isApprox(Vec3(0.1, 0.08, 0.05)));
  EXPECT_TRUE(device->needle_centre.isApprox(Vec3(0.01, 0, -0.02)));
  EXPECT_FALSE(device->probe_half.allFinite()) << "its device has no box";
}

TEST(DeviceFile, AProbeThatIsNotToldOfIsHeldByADeviceOfTheNeedlesKind) {
  const auto device =
      parse_device_file("format = 1\nname = \"a\"\n[needle]\nforce_n = 4\n", "a.toml");
  ASSERT_TRUE(device) << device.error().to_string();
  EXPECT_EQ(device->probe_force, 4);
  EXPECT_EQ(device->probe_torque, 0);
}

TEST(DeviceFile, IsRefusedWithAllThatIsWrongInItsOwnUnits) {
  const auto device = parse_device_file(
      "format = 1\nname = \"a\"\n[needle]\nforce_n = 1e6\ntorqe_nm = 1\n[probe]\nforce_n = 3\n"
      "centre_mm = [0, 0, 0]\n",
      "bad.toml");
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().code, ErrorCode::invalid);
  const std::string said = device.error().to_string();
  for (const char* word : {"force_n", "torqe_nm", "torque_nm", "centre_mm", "bad.toml"})
    EXPECT_NE(said.find(word), std::string::npos) << word << " in " << said;
  EXPECT_FALSE(parse_device_file("format = 1\nname = \"a\"\n", "none.toml"));
  EXPECT_FALSE(read_device_file("/nowhere/device.toml"));
}

TEST(DeviceLimits, OfTheTableHoldForTheProbesHandToo) {
  EXPECT_EQ(find_device("touch")->probe_force, 3);
  EXPECT_EQ(find_device("falcon")->force, 8) << "a device that a bridge drives";
  EXPECT_EQ(find_device("virtuose_6d_desktop")->probe_torque, 0.8);
  const DeviceLimits mixed = with_probe_device(*find_device("touch"), *find_device("delta"));
  EXPECT_EQ(mixed.force, 3);
  EXPECT_EQ(mixed.probe_force, 12);
}

}  // namespace
}  // namespace artus
