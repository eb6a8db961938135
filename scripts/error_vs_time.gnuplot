# gnuplot -c error_vs_time.gnuplot REPORT.csv PLOT.png: estimated error and unshot fraction against run time.
set terminal pngcairo size 900,560 font "sans,11"
set output ARG2
set datafile separator ","
set title "Error against run time"
set xlabel "run time, s"
set ylabel "fraction"
set logscale y
set format y "10^{%T}"
set grid xtics ytics lc rgb "#dddddd"
set key top right
set yrange [1e-7:2]
plot ARG1 every ::1 using 1:7 with linespoints lw 2 pt 7 ps 0.7 lc rgb "#c0392b" title "estimated error (nRMSE of irradiance)", \
     ARG1 every ::1 using 1:6 with linespoints lw 2 pt 5 ps 0.6 lc rgb "#2c5f8a" title "unshot power / emitted power"
