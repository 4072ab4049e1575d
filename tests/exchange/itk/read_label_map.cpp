// SPDX-License-Identifier: AGPL-3.0-or-later
// What ITK reads from a label map: size, sum of the labels, and the places of the first voxel and
// of three that lie 100 voxels along each axis, LPS mm.
#include <cstdio>
#include <exception>

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageRegionConstIterator.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using Image = itk::Image<unsigned short, 3>;
  const auto reader = itk::ImageFileReader<Image>::New();
  reader->SetFileName(argv[1]);
  try {
    reader->Update();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  const Image* image = reader->GetOutput();
  const auto size = image->GetLargestPossibleRegion().GetSize();
  unsigned long long sum = 0;
  itk::ImageRegionConstIterator<Image> voxel(image, image->GetLargestPossibleRegion());
  for (; !voxel.IsAtEnd(); ++voxel) sum = sum * 31 + voxel.Get();
  std::printf("%lu %lu %lu %llu", static_cast<unsigned long>(size[0]),
              static_cast<unsigned long>(size[1]), static_cast<unsigned long>(size[2]), sum);
  for (int k = 0; k < 4; ++k) {
    Image::IndexType index{{0, 0, 0}};
    if (k > 0) index[k - 1] = 100;
    Image::PointType p;
    image->TransformIndexToPhysicalPoint(index, p);
    std::printf(" %.3f %.3f %.3f", p[0] + 0.0, p[1] + 0.0, p[2] + 0.0);
  }
  std::printf("\n");
  return 0;
}
