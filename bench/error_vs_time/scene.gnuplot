# gnuplot -c scene.gnuplot CURVES.dat PLOT.png NAME: error of one scene against CPU seconds and against rays.
set terminal pngcairo noenhanced size 1500,760 font "sans,12"
set output ARG2
set logscale xy
set grid lt 1 lw 0.8 lc rgb "#dcdcdc"
set format y "%g %%"
set ytics (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500)
set ylabel "error (nRMSE of irradiance)"
set tmargin 3
set bmargin 8

# All that is drawn, estimates too; what is below a tenth of a percent is noise of the truth.
shown(error) = error > 0.001 ? 100 * error : NaN
stats ARG1 using (shown($5)) name "TRUE" nooutput
stats ARG1 index 0 using (shown($8)) name "SAID" nooutput
low = TRUE_min < SAID_min ? TRUE_min : SAID_min
low = low < 1 ? low : 1  # extrapolations end at 1 %
high = TRUE_max > SAID_max ? TRUE_max : SAID_max
set yrange [0.7*low : 1.5*high]

red = "#c0392b"; blue = "#2c5f8a"; green = "#3a9d5d"; orange = "#d68910"; violet = "#8e44ad"; black = "#222222"; grey = "#7f8c8d"
set multiplot layout 1,2 title sprintf("%s: error against CPU seconds and rays, one thread", ARG3) font "sans,15"

set xlabel "CPU seconds (path tracing: of 10 000 points; dotted: extrapolated)"
set format x "%g"
set key at screen 0.5,0.012 center bottom maxrows 2 samplen 2.5 width 1
plot ARG1 index 0 using 1:(shown($5)):2:3:(shown($6)):(shown($7)) with xyerrorbars pt 7 ps 0 lw 1.2 lc rgb red notitle, \
     "" index 0 using 1:(shown($5)) with linespoints lw 2.5 pt 7 ps 1.1 lc rgb red title "Alvor, true", \
     "" index 0 using 1:(shown($8)) with linespoints lw 2 dt "-" pt 6 ps 1.1 lc rgb red title "Alvor, estimated", \
     "" index 1 using 1:(shown($5)) with points pt 9 ps 1.2 lc rgb blue title "gather", \
     "" index 2 using 1:(shown($5)) with points pt 11 ps 1.2 lc rgb green title "shoot", \
     "" index 3 using 1:(shown($5)) with points pt 5 ps 0.9 lc rgb orange title "sorted", \
     "" index 4 using 1:(shown($5)) with points pt 13 ps 1.2 lc rgb violet title "overshoot", \
     "" index 5 using 1:(shown($5)) with linespoints lw 2 pt 4 ps 1.2 lc rgb black title "textbook shooting", \
     "" index 6 using 1:(shown($5)) with linespoints lw 2 pt 8 ps 1.2 lc rgb grey title "path tracing", \
     "" index 7 using 1:(shown($2)) with lines lw 2 dt "." lc rgb grey notitle

set key off
set xlabel "rays (those of path tracing are not counted)"
set format x "%.0s %c"
plot ARG1 index 0 using 4:(shown($5)):(shown($6)):(shown($7)) with yerrorbars pt 7 ps 0 lw 1.2 lc rgb red, \
     "" index 0 using 4:(shown($5)) with linespoints lw 2.5 pt 7 ps 1.1 lc rgb red, \
     "" index 0 using 4:(shown($8)) with linespoints lw 2 dt "-" pt 6 ps 1.1 lc rgb red, \
     "" index 1 using 4:(shown($5)) with points pt 9 ps 1.2 lc rgb blue, \
     "" index 2 using 4:(shown($5)) with points pt 11 ps 1.2 lc rgb green, \
     "" index 3 using 4:(shown($5)) with points pt 5 ps 0.9 lc rgb orange, \
     "" index 4 using 4:(shown($5)) with points pt 13 ps 1.2 lc rgb violet, \
     "" index 5 using 4:(shown($5)) with linespoints lw 2 pt 4 ps 1.2 lc rgb black
unset multiplot
