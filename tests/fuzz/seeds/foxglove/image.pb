
€âÏª€åšwÿØÿàdatajpeg"cam