"""Scenes of patients: from the label map of a segmented image, and by the hundred from published distributions.

    rosrun vibe_python vibe_import segmentation.nii.gz --label 6 --output patient/
    rosrun vibe_python vibe_population --count 100 --seed 1 --output stomachs/

docs/patients.md of the repository says what they do. vibe_import needs the Debian packages python3-nibabel, python3-skimage,
python3-scipy and python3-matplotlib.
"""
