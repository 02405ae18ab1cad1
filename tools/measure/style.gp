# The look of all charts: gnuplot runs this before the script of a chart.

if (GPVAL_VERSION < 5.4) exit error 'gnuplot 5.4 or newer is needed'

look = "dynamic noenhanced font 'DejaVu Sans,13' background rgb 'white'"
eval 'set terminal svg size 900,600 ' . look
set encoding utf8
set datafile separator comma
set datafile columnheaders
set border 3 linecolor rgb '#555555'
set tics nomirror textcolor rgb '#333333'
set grid linecolor rgb '#dddddd' linetype 1 linewidth 1
set key outside right top vertical Left reverse noenhanced samplen 2
set key spacing 1.1
# The first label says where the figures are from: the device, the processor, the commit.
set label 1 '' at screen 0.01, 0.985 left font ',9' textcolor rgb '#777777' noenhanced

# Colours of M. Okabe and K. Ito, which colour-blind readers can tell apart. Cyber Radar's methods are filled.
set linetype 1 linewidth 1.5 linecolor rgb '#0072b2' pointtype 7 pointsize 0.9
set linetype 2 linewidth 1.5 linecolor rgb '#0072b2' pointtype 5 pointsize 0.8
set linetype 3 linewidth 1.5 linecolor rgb '#d55e00' pointtype 13 pointsize 0.9
set linetype 4 linewidth 1.5 linecolor rgb '#e69f00' pointtype 11 pointsize 0.9
set linetype 5 linewidth 1.5 linecolor rgb '#000000' pointtype 9 pointsize 0.9
# Other libraries, up to 20, are hollow.
set linetype 6 linewidth 1.5 linecolor rgb '#009e73' pointtype 6 pointsize 1.1
set linetype 7 linewidth 1.5 linecolor rgb '#009e73' pointtype 12 pointsize 1.2
set linetype 8 linewidth 1.5 linecolor rgb '#cc79a7' pointtype 4 pointsize 1
set linetype 9 linewidth 1.5 linecolor rgb '#56b4e9' pointtype 10 pointsize 1.2
set linetype 10 linewidth 1.5 linecolor rgb '#56b4e9' pointtype 8 pointsize 1.2
set linetype 11 linewidth 1.5 linecolor rgb '#8c6d00' pointtype 14 pointsize 1.1
# The front, with a ring around each of its methods, and what the paper measured.
set linetype 21 linewidth 2 linecolor rgb '#999999' dashtype 2 pointtype 6 pointsize 1.8
set linetype 22 linewidth 1.5 linecolor rgb '#000000' dashtype 2 pointtype 1
set linetype 23 linewidth 1.5 linecolor rgb '#000000' dashtype 3 pointtype 2
